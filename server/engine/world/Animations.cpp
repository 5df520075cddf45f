#include "engine/world/Animations.h"

#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

Animations::~Animations() {
  for (Object* p_o : m_objects) p_o->m_p_extras->animated = ObjectExtras::kNowhere;
}

void Animations::add(Object& object) {
  ObjectExtras& extras = *object.m_p_extras;
  if (extras.animated != ObjectExtras::kNowhere) return;
  extras.animated = m_objects.size();
  m_objects.push_back(&object);
}

void Animations::remove(Object& object) {
  ObjectExtras& extras = *object.m_p_extras;
  if (extras.animated == ObjectExtras::kNowhere) return;
  Object* p_last = m_objects.back();
  m_objects[extras.animated] = p_last;
  p_last->m_p_extras->animated = extras.animated;
  m_objects.pop_back();
  extras.animated = ObjectExtras::kNowhere;
}

// One Object's frame is no other one's business, so their order does not matter.
void Animations::advance() {
  constexpr std::uint32_t kShown = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kVisible;
  for (Object* p_o : m_objects) {
    const WorldStore& store = *p_o->m_p_store;
    if ((store.flags(p_o->m_slot) & kShown) != kShown) continue;
    if (p_o->m_p_extras->animation.advance() && store.has(p_o->m_slot, WorldStore::kStaticLook)) {
      store.world()->forgetLook(p_o->m_slot);
    }
  }
}

}  // namespace df
