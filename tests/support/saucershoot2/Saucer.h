// A saucer that comes in from the right. A shot saucer is replaced by another; each that gets through brings
// one more.
#pragma once

#include "EventCollision.h"
#include "Object.h"

class Saucer : public df::Object {
 public:
  Saucer();
  ~Saucer() override;
  int eventHandler(const df::Event* p_e) override;

 private:
  void out();
  void hit(const df::EventCollision* p_collision_event);
  void moveToStart();

  bool shot;
};
