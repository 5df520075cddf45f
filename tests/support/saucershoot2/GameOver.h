// The game-over message. It lasts until its animation ends; then the title is shown again.
#pragma once

#include "ViewObject.h"

class GameOver : public df::ViewObject {
 public:
  GameOver();
  ~GameOver() override;
  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  void step();

  int time_to_live;
};
