// The enemy. Saucers enter on the right, fly to the left, and enter again until they are shot down.
#pragma once

#include <cstdint>

#include "Object.h"

class Saucer : public df::Object {
 public:
  /// Creates a saucer that is about to enter on the right.
  Saucer();

  /// Handles a hit by a bullet of `player`. Returns false if the saucer has already exploded.
  bool shotBy(std::uint32_t player);
  /// Explodes. Returns false if it has already exploded.
  bool explode();

  int eventHandler(const df::Event* p_e) override;

 private:
  struct Kind {
    const char* sprite;
    double speed;  // speed to the left, in cells per tick
    double drift;  // speed up or down, in rows per tick
    int points;
  };
  static const Kind kDrone, kWeaver, kRaider;
  static const Kind& anyKind();

  void enter();
  void steer();
  void swerve(const df::Object* p_other);
  void setDrift(int direction);

  const Kind& m_kind;
  bool m_exploded = false;
};
