#include "Controls.h"

void Controls::Lever::pull(int to, bool down) {
  if (down) {
    direction = to;
    let_go = false;
  } else if (direction == to) {
    let_go = true;
  }
}

void Controls::Lever::step() {
  if (let_go) *this = Lever();
}

void Controls::key(const df::EventKeyboard& event) {
  const bool down = event.getKeyboardAction() != df::KEY_RELEASED;
  if (down) m_silence = 0;  // any key will do: keyboards repeat only the one that was pressed last

  switch (event.getKey()) {
    case df::Keyboard::LEFTARROW:
    case df::Keyboard::A:
      m_horizontal.pull(-1, down);
      break;
    case df::Keyboard::RIGHTARROW:
    case df::Keyboard::D:
      m_horizontal.pull(1, down);
      break;
    case df::Keyboard::UPARROW:
    case df::Keyboard::W:
      m_vertical.pull(-1, down);
      break;
    case df::Keyboard::DOWNARROW:
    case df::Keyboard::S:
      m_vertical.pull(1, down);
      break;
    case df::Keyboard::SPACE:
      m_firing = down;
      break;
    default:
      break;
  }
}

void Controls::step() {
  m_horizontal.step();
  m_vertical.step();
  if (++m_silence > kPatience) *this = Controls();
}
