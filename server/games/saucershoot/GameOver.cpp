#include "GameOver.h"

#include "EventStep.h"
#include "Events.h"
#include "WorldManager.h"

GameOver::GameOver() {
  setType("GameOver");
  if (setSprite("gameover") == 0)
    m_time_to_live = 3 * getSprite()->getFrameCount() * getSprite()->getSlowdown();
  setLocation(df::CENTER_CENTER);
  registerInterest(df::STEP_EVENT);
}

int GameOver::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::STEP_EVENT) return 0;
  if (--m_time_to_live > 0) return 1;
  const EventRound title(EventRound::TITLE);
  WM.onEvent(&title);
  WM.markForDelete(this);
  return 1;
}

// Draws the sprite, not the text and value that a ViewObject draws.
int GameOver::draw() {
  return df::Object::draw();  // NOLINT(bugprone-parent-virtual-call)
}
