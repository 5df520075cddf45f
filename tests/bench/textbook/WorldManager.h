// Listings 4.54, 4.101 and 4.106 of the Dragonfly book, with the boundary of its section 4.13.4.
#pragma once

#include "Object.h"
#include "ObjectList.h"
#include "Vector.h"

#define WM textbook::WorldManager::getInstance()

namespace textbook {

class WorldManager {
 private:
  WorldManager();

  ObjectList m_updates;    // All Objects in world to update.
  ObjectList m_deletions;  // All Objects in world to delete.
  Vector m_boundary;       // Width and height of the world.

  bool isInside(Vector position) const;

 public:
  static WorldManager& getInstance();

  // Delete all game world Objects.
  void shutDown();
  void setBoundary(Vector new_boundary);

  int insertObject(Object* p_o);
  int removeObject(Object* p_o);
  int markForDelete(Object* p_o);
  int getCount() const;
  Object* getObject(int index) const;

  // Update world. Update positions of Objects based on their velocities. Delete Objects marked for deletion.
  void update();

  // Return list of Objects collided with at position `where`.
  // Collisions only with solid Objects. Does not consider if p_o is solid or not.
  ObjectList getCollisions(const Object* p_o, Vector where);

  // Move Object. If no collision with solid, move ok else don't move Object. If Object is Spectral, move ok.
  // Return 0 if move ok, else -1 if collision with solid.
  int moveObject(Object* p_o, Vector where);
};

}  // namespace textbook
