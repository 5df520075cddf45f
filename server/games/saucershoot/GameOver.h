// The end of the round: shown while its sprite plays three times, then the title comes back.
#pragma once

#include "ViewObject.h"

class GameOver : public df::ViewObject {
 public:
  GameOver();
  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  int m_time_to_live = 1;  // in ticks
};
