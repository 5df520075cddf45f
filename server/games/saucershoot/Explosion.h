// The remains of a saucer or a ship, shown while their sprite plays.
#pragma once

#include "Object.h"

class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector position, df::Vector velocity = df::Vector());

  int eventHandler(const df::Event* p_e) override;

 private:
  int m_time_to_live = 1;  // in ticks
};

/// Makes several explosions that fly apart: the end of a ship.
void explodeShip(df::Vector position);
