// The explosion of a saucer or ship. It lasts until its animation ends.
#pragma once

#include "Object.h"

class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector where);
  int eventHandler(const df::Event* p_e) override;

 private:
  int time_to_live;
};
