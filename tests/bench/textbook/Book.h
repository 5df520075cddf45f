// The listings of the Dragonfly book that the workload needs, without getters and setters that it does not
// call: 4.26 and following (Vector), 4.34, 4.99, 4.103, 4.104, 4.110 (Object), 4.39 (ObjectList, with the
// optional growing array in place of MAX_OBJECTS entries), 4.51 (Event), 4.54, 4.101, 4.106 and
// section 4.13.4 (WorldManager), 4.105 (EventCollision), 4.107 (positionsIntersect), 4.112 (EventOut). Each
// class has its own source file, as in the book.
#pragma once

#include <string>

#define WM textbook::WorldManager::getInstance()

namespace textbook {

class Vector {
 private:
  float m_x;  // Horizontal component.
  float m_y;  // Vertical component.

 public:
  Vector();
  Vector(float init_x, float init_y);

  float getX() const;
  float getY() const;

  float getMagnitude() const;
  // Resize vector to have magnitude of 1.
  void normalize();
  void scale(float s);

  Vector operator+(const Vector& other) const;
  Vector operator-(const Vector& other) const;
  bool operator!=(const Vector& other) const;
};

const std::string UNDEFINED_EVENT = "df::undefined";
const std::string COLLISION_EVENT = "df::collision";
const std::string OUT_EVENT = "df::out";

class Event {
 private:
  std::string m_event_type;  // Holds event type.

 public:
  Event();
  virtual ~Event();

  void setType(std::string new_type);
  std::string getType() const;
};

enum Solidness {
  HARD,      // Object causes collisions and impedes.
  SOFT,      // Object causes collisions, but doesn't impede.
  SPECTRAL,  // Object doesn't cause collisions.
};

class Object {
 private:
  int m_id;               // Unique game engine defined identifier.
  std::string m_type;     // Game programmer defined type.
  Vector m_position;      // Position in game world.
  int m_altitude;         // 0 to MAX_ALTITUDE supported.
  Vector m_direction;     // Direction vector.
  float m_speed;          // Object speed in direction.
  Solidness m_solidness;  // Solidness of object.
  bool m_no_soft;         // True if won't move onto soft objects.

 public:
  // Construct Object. Set default parameters and add to game world (WorldManager).
  Object();
  // Destroy Object. Remove from game world (WorldManager).
  virtual ~Object();

  void setType(std::string new_type);
  void setPosition(Vector new_pos);
  Vector getPosition() const;

  // Set direction and speed of Object.
  void setVelocity(Vector new_velocity);
  // Get velocity of Object based on direction and speed.
  Vector getVelocity() const;
  // Predict Object position based on speed and direction.
  Vector predictPosition();

  bool isSolid() const;
  int setSolidness(Solidness new_solid);
  Solidness getSolidness() const;
  bool getNoSoft() const;

  // Handle event. Return 0 if ignored, else 1.
  virtual int eventHandler(const Event* p_e);
};

class EventCollision : public Event {
 private:
  Vector m_pos;      // Where collision occurred.
  Object* m_p_obj1;  // Object moving, causing collision.
  Object* m_p_obj2;  // Object being collided with.

 public:
  EventCollision(Object* p_o1, Object* p_o2, Vector p);

  Object* getObject1() const;
  Object* getObject2() const;
};

class EventOut : public Event {
 public:
  EventOut();
};

class ObjectList {
 private:
  int m_count;       // Count of objects in list.
  int m_max_count;   // Size of array.
  Object** m_p_obj;  // Array of pointers to objects.

 public:
  ObjectList();
  ObjectList(const ObjectList& other);
  ObjectList& operator=(const ObjectList& other) = delete;
  ~ObjectList();

  // Insert object pointer in list. Return 0 if ok, else -1.
  int insert(Object* p_o);
  // Remove object pointer from list. Return 0 if found, else -1.
  int remove(Object* p_o);
  void clear();
  int getCount() const;
  bool isEmpty() const;
  Object* operator[](int index) const;
};

// Return true if two positions intersect, else false.
bool positionsIntersect(Vector p1, Vector p2);

class WorldManager {
 private:
  WorldManager();

  ObjectList m_updates;  // All Objects in world to update.
  Vector m_boundary;     // Width and height of the world.

  bool isInside(Vector position) const;

 public:
  static WorldManager& getInstance();

  // Delete all game world Objects.
  void shutDown();
  void setBoundary(Vector new_boundary);

  int insertObject(Object* p_o);
  int removeObject(Object* p_o);
  int getCount() const;
  Object* getObject(int index) const;

  // Update positions of Objects based on their velocities.
  void update();

  // Return list of Objects collided with at position `where`.
  // Collisions only with solid Objects. Does not consider if p_o is solid or not.
  ObjectList getCollisions(const Object* p_o, Vector where);

  // Move Object. If no collision with solid, move ok else don't move Object. If Object is Spectral, move ok.
  // Return 0 if move ok, else -1 if collision with solid.
  int moveObject(Object* p_o, Vector where);
};

}  // namespace textbook
