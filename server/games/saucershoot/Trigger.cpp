#include "Trigger.h"

void Trigger::key(const df::EventKeyboard& event) {
  const bool down = event.getKeyboardAction() != df::KEY_RELEASED;
  if (down) m_idle = 0;  // any key counts, because keyboards repeat only the key that was pressed last
  if (event.getKey() == df::Keyboard::SPACE) m_pulled = down;
}

void Trigger::step() {
  if (++m_idle > kPatience) *this = Trigger();
}
