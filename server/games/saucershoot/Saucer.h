// The enemy. Saucers come in on the right, fly left, and come back again unless somebody stops them.
#pragma once

#include <cstdint>

#include "Object.h"

class Saucer : public df::Object {
 public:
  /// About to come in on the right.
  Saucer();

  /// Hit by a bullet of `player`. Return false if it has blown up before.
  bool shotBy(std::uint32_t player);
  /// It blows up. Return false if it has done so before.
  bool explode();

  int eventHandler(const df::Event* p_e) override;

 private:
  struct Kind {
    const char* sprite;
    double speed;  // to the left, cells per tick
    double drift;  // up or down
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
