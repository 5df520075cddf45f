// The end of the round. Its sprite plays three times, then the title is shown again.
#pragma once

#include "ViewObject.h"

class GameOver : public df::ViewObject {
 public:
  GameOver();
  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  int m_time_to_live = 1;  // remaining ticks
};
