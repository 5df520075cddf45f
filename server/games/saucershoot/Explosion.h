// A short flash of characters where something blew up, and gone.
#pragma once

#include "Object.h"

class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector position, df::Vector velocity = df::Vector());

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  int m_age = 0;  // in ticks
};

/// Many of them at once, flying apart: the end of a ship.
void explodeShip(df::Vector position);
