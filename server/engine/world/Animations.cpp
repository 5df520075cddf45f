#include "engine/world/Animations.h"

#include "engine/world/ObjectExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

Animations::~Animations() {
  for (const Entry& entry : m_entries) entry.p_extras->animated = ObjectExtras::kNowhere;
}

void Animations::add(std::uint32_t slot, ObjectExtras& extras) {
  if (extras.animated != ObjectExtras::kNowhere) return;
  extras.animated = m_entries.size();
  m_entries.push_back({slot, &extras});
}

void Animations::remove(ObjectExtras& extras) {
  if (extras.animated == ObjectExtras::kNowhere) return;
  m_entries[extras.animated] = m_entries.back();
  m_entries.back().p_extras->animated = extras.animated;
  m_entries.pop_back();
  extras.animated = ObjectExtras::kNowhere;
}

// One Object's frame is no other one's business, so their order does not matter.
void Animations::advance() {
  constexpr std::uint32_t kShown = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kVisible;
  for (const auto& [slot, p_extras] : m_entries) {
    if ((m_store.flags(slot) & kShown) != kShown) continue;
    if (p_extras->animation.advance()) m_store.set(slot, WorldStore::kLookKept, false);
  }
}

}  // namespace df
