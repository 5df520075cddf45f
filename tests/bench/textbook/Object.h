// Listings 4.34, 4.99, 4.103, 4.104 and 4.110 of the Dragonfly book, without the getters and setters that the
// workload does not call.
#pragma once

#include <string>

#include "Event.h"
#include "Vector.h"

namespace textbook {

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
  std::string getType() const;
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

}  // namespace textbook
