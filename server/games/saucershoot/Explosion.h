// The remains of a saucer or a ship. It disappears when its sprite has been shown once.
#pragma once

#include "Object.h"

class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector position, df::Vector velocity = df::Vector());

  int eventHandler(const df::Event* p_e) override;

 private:
  int m_time_to_live = 1;  // remaining ticks
};

/// Makes several explosions that fly apart, for the end of a ship.
void explodeShip(df::Vector position);
