// The part of Object that walks along paths.

#include <utility>

#include "engine/world/InterestDispatch.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/PathFind.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

void Object::pathTo(Vector position) {
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  setAvoidCollisions();
  Path path = findPath(*this, position);
  EventPath event(path);
  if (path.getPath().empty()) event.setResult(NOT_FOUND);
  setFollowPath(false);
  setPath(std::move(path));
  if (event.getResult() == FOUND) setFollowPath();
  p_world->nameClassOf(event);
  p_world->deliver(key(), event);  // the last thing: it may delete this
}

void Object::pathTo(const Object* p_o_target) {
  if (p_o_target != nullptr) pathTo(p_o_target->getPosition());
}

void Object::moveTo(Vector new_position) {
  Vector direction = new_position - getPosition();
  direction.normalize();
  setDirection(direction);
}

void Object::setPath(Path new_path) {
  extras().path = std::move(new_path);
}

Path Object::getPath() const {
  return m_p_extras != nullptr ? m_p_extras->path : Path();
}

void Object::setFollowPath(bool new_follow_path) {
  if (!new_follow_path && m_p_extras == nullptr) return;
  extras().follows_path = new_follow_path;
  if (!new_follow_path) m_p_extras->path_speed = 0;
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  if (new_follow_path) {
    p_world->extras().walkers.add(*this);
  } else {
    p_world->extras().walkers.remove(*this);
  }
}

bool Object::getFollowPath() const {
  return m_p_extras != nullptr && m_p_extras->follows_path;
}

void Object::setAvoidCollisions(bool new_avoid_collisions) {
  extras().avoids_collisions = new_avoid_collisions;
}

bool Object::getAvoidCollisions() const {
  return m_p_extras != nullptr && m_p_extras->avoids_collisions;
}

// At a node when the next step would pass it; there the Object is put on it exactly, by a step of just that
// length, so that it turns where the path does.
void Object::stepPath() {
  if (!m_p_store->has(m_slot, WorldStore::kInWorld) || !isActive()) return;
  Path& path = m_p_extras->path;
  while (!path.getPath().empty() && path.nextNode() == getPosition()) {
    if (path.endOfPath()) {
      setFollowPath(false);
      setVelocity(Vector());
      return;
    }
    path++;
  }
  const double speed = m_p_extras->path_speed > 0 ? m_p_extras->path_speed : getSpeed();
  if (path.getPath().empty() || !(speed > 0)) return;
  m_p_extras->path_speed = speed;
  Vector displacement = path.nextNode() - getPosition();
  const double left = displacement.getMagnitude();
  if (left > speed) displacement.scale(speed / left);
  setVelocity(displacement);
}

}  // namespace df
