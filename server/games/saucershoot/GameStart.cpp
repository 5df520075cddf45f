#include "GameStart.h"

#include "EventKeyboard.h"
#include "Events.h"
#include "WorldManager.h"

GameStart::GameStart() {
  setType("GameStart");
  setSprite("gamestart");
  setLocation(df::CENTER_CENTER);
  registerInterest(df::KEYBOARD_EVENT);
  registerInterest(ROUND_EVENT);
}

int GameStart::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::KEYBOARD_EVENT) {
    const auto* p_keyboard = static_cast<const df::EventKeyboard*>(p_e);
    if (p_keyboard->getKeyboardAction() != df::KEY_PRESSED) return 0;
    const df::Keyboard::Key key = p_keyboard->getKey();
    if (key != df::Keyboard::SPACE && key != df::Keyboard::P && key != df::Keyboard::RETURN) return 0;
    const EventRound begin(EventRound::FLYING);
    WM.onEvent(&begin);
    return 1;
  }
  if (p_e->getType() == ROUND_EVENT) {
    setActive(false);  // at once, so that another key in this tick does not begin a second round
    WM.markForDelete(this);
    return 1;
  }
  return 0;
}

// Draws the sprite, not the text and value that a ViewObject draws.
int GameStart::draw() {
  return df::Object::draw();  // NOLINT(bugprone-parent-virtual-call)
}
