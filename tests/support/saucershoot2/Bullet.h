// A bullet fired by the hero.
#pragma once

#include "EventCollision.h"
#include "Object.h"

class Bullet : public df::Object {
 public:
  explicit Bullet(df::Vector hero_pos);
  int eventHandler(const df::Event* p_e) override;

 private:
  void out();
  void hit(const df::EventCollision* p_collision_event);
};
