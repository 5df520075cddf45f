// The title. The first key that any player presses begins the round for all players.
#pragma once

#include "ViewObject.h"

class GameStart : public df::ViewObject {
 public:
  GameStart();
  int eventHandler(const df::Event* p_e) override;
  int draw() override;
};
