#include "engine/world/Walkers.h"

#include <algorithm>

#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

Walkers::~Walkers() {
  for (Object* p_o : m_objects) p_o->m_p_extras->follows_path = false;
}

void Walkers::set(Object& object, bool walks) {
  const auto place = std::find(m_objects.begin(), m_objects.end(), &object);
  if (walks && place == m_objects.end()) m_objects.push_back(&object);
  if (!walks && place != m_objects.end()) m_objects.erase(place);
}

void Walkers::step() {
  const std::vector<Object*> walkers = m_objects;  // those that arrive take themselves out
  for (Object* p_o : walkers) turn(*p_o);
}

// At a node when the next step would pass it; there the Object is put on it exactly, by a step of just that
// length, so that it turns where the path does.
void Walkers::turn(Object& object) {
  if (!object.m_p_store->has(object.m_slot, WorldStore::kInWorld) || !object.isActive()) return;
  ObjectExtras& extras = *object.m_p_extras;
  Path& path = extras.path;
  while (!path.getPath().empty() && path.nextNode() == object.getPosition()) {
    if (path.endOfPath()) {
      object.setFollowPath(false);
      object.setVelocity(Vector());
      return;
    }
    path++;
  }
  const double speed = extras.path_speed > 0 ? extras.path_speed : object.getSpeed();
  if (path.getPath().empty() || !(speed > 0)) return;
  extras.path_speed = speed;
  Vector displacement = path.nextNode() - object.getPosition();
  const double left = displacement.getMagnitude();
  if (left > speed) displacement.scale(speed / left);
  object.setVelocity(displacement);
}

}  // namespace df
