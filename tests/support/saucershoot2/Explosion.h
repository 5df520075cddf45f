// What is left of a saucer or a ship, for as long as its sprite takes.
#pragma once

#include "Object.h"

class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector where);
  int eventHandler(const df::Event* p_e) override;

 private:
  int time_to_live;
};
