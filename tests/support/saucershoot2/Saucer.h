// It comes in from the right. For each that is shot another one comes; for each that gets through, one more.
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
