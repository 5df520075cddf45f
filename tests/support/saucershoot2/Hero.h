// The player's ship: W and S move it, the mouse fires, space sets off a nuke.
#pragma once

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Object.h"
#include "Reticle.h"

class Hero : public df::Object {
 public:
  Hero();
  ~Hero() override;
  int eventHandler(const df::Event* p_e) override;

 private:
  void kbd(const df::EventKeyboard* p_keyboard_event);
  void mouse(const df::EventMouse* p_mouse_event);
  void step();
  void move(int dy);
  void fire(df::Vector target);
  void nuke();

  Reticle* p_reticle;
  int move_slowdown;
  int move_countdown;
  int fire_slowdown;
  int fire_countdown;
  int nuke_count;
};
