#include "engine/widgets/Fraps.h"

#include <algorithm>
#include <cmath>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventStep.h"
#include "engine/managers/GameManager.h"

namespace df {

Fraps::Fraps(bool /*do_record*/) {
  ViewObject::setViewString(FRAPS_STRING);
  ViewObject::setLocation(TOP_RIGHT);
  ViewObject::setColor(GREEN);
  registerInterest(STEP_EVENT);
  registerInterest(KEYBOARD_EVENT);
}

int Fraps::eventHandler(const Event* p_e) {
  if (p_e->getType() == STEP_EVENT) {
    setValue(static_cast<int>(std::lround(1000.0 / std::max(1, GM.getFrameTime()))));
    return 1;
  }
  const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
  if (p_key != nullptr && p_key->getKey() == Keyboard::F9 && p_key->getKeyboardAction() == KEY_PRESSED) {
    setVisible(!isVisible());
    return 1;
  }
  return ViewObject::eventHandler(p_e);
}

}  // namespace df
