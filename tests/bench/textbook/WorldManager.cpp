#include "Book.h"

namespace textbook {

WorldManager::WorldManager() {}

WorldManager& WorldManager::getInstance() {
  static WorldManager world_manager;
  return world_manager;
}

void WorldManager::shutDown() {
  ObjectList all = m_updates;
  m_updates.clear();
  for (int i = 0; i < all.getCount(); i++) delete all[i];
}

void WorldManager::setBoundary(Vector new_boundary) {
  m_boundary = new_boundary;
}

int WorldManager::insertObject(Object* p_o) {
  return m_updates.insert(p_o);
}

int WorldManager::removeObject(Object* p_o) {
  return m_updates.remove(p_o);
}

int WorldManager::getCount() const {
  return m_updates.getCount();
}

Object* WorldManager::getObject(int index) const {
  return m_updates[index];
}

bool WorldManager::isInside(Vector position) const {
  return position.getX() >= 0 && position.getX() < m_boundary.getX() && position.getY() >= 0 &&
         position.getY() < m_boundary.getY();
}

void WorldManager::update() {
  // Iterate through all Objects.
  for (int i = 0; i < m_updates.getCount(); i++) {
    // Add velocity to position.
    Vector new_pos = m_updates[i]->predictPosition();
    // If Object should change position, then move.
    if (new_pos != m_updates[i]->getPosition()) moveObject(m_updates[i], new_pos);
  }
}

ObjectList WorldManager::getCollisions(const Object* p_o, Vector where) {
  // Make empty list.
  ObjectList collision_list;
  // Iterate through all Objects.
  for (int i = 0; i < m_updates.getCount(); i++) {
    Object* p_temp_o = m_updates[i];
    if (p_temp_o != p_o) {  // Do not consider self.
      // Same location and both solid?
      if (positionsIntersect(p_temp_o->getPosition(), where) && p_temp_o->isSolid()) {
        collision_list.insert(p_temp_o);
      }
    }
  }
  return collision_list;
}

int WorldManager::moveObject(Object* p_o, Vector where) {
  if (p_o->isSolid()) {  // Need to be solid for collisions.
    // Get collisions.
    ObjectList list = getCollisions(p_o, where);
    if (!list.isEmpty()) {
      bool do_move = true;  // Assume can move.
      // Iterate over list.
      for (int i = 0; i < list.getCount(); i++) {
        Object* p_temp_o = list[i];
        // Create collision event.
        EventCollision c(p_o, p_temp_o, where);
        // Send to both objects.
        p_o->eventHandler(&c);
        p_temp_o->eventHandler(&c);
        // If both HARD, then cannot move.
        if (p_o->getSolidness() == HARD && p_temp_o->getSolidness() == HARD) do_move = false;
        // If object does not want to move onto soft objects, don't move.
        if (p_o->getNoSoft() && p_temp_o->getSolidness() == SOFT) do_move = false;
      }
      if (!do_move) return -1;  // Move not allowed.
    }
  }

  // If here, no collision between two HARD objects so allow move.
  const bool was_inside = isInside(p_o->getPosition());
  p_o->setPosition(where);
  if (was_inside && !isInside(where)) {
    // Generate out of bounds event and send to Object.
    EventOut ov;
    p_o->eventHandler(&ov);
  }
  return 0;
}

}  // namespace textbook
