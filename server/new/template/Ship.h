// A player's ship.
#pragma once

#include "Controls.h"
#include "DisplayManager.h"
#include "PlayerObject.h"

class Ship : public df::PlayerObject<> {
 public:
  explicit Ship(df::Player& player) : PlayerObject(player) {
    setType("Ship");
    setSolidness(df::SOFT);
    setPosition(df::Vector(10 + WM.randomInt(60), 12));
    df::Controls controls;
    controls.onKey(df::Keyboard::LEFTARROW).drive(-1, 0);
    controls.onKey(df::Keyboard::RIGHTARROW).drive(1, 0);
    controls.onKey(df::Keyboard::UPARROW).drive(0, -0.5);
    controls.onKey(df::Keyboard::DOWNARROW).drive(0, 0.5);
    controls.within(df::Box(df::Vector(2, 2), 75, 19));
    player.setControls(controls);
  }

  int draw() override { return DM.drawCh(getPosition(), '@', getColor()); }
};
