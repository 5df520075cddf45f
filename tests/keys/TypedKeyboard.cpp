#include "TypedKeyboard.h"

#include <stdexcept>

namespace naiad {

using df::Keyboard::Key;

std::string TypedKeyboard::press(Key key, Time now) {
  m_down.insert(key);
  m_repeats = key;
  m_due = now + m_options.pause;
  return bytes(key, '1');
}

std::string TypedKeyboard::release(Key key) {
  m_down.erase(key);
  if (m_repeats == key) m_repeats = df::Keyboard::UNDEFINED_KEY;
  return m_options.kitty ? bytes(key, '3') : "";
}

std::string TypedKeyboard::repeat(Time now) {
  if (m_repeats == df::Keyboard::UNDEFINED_KEY || now < m_due) return "";
  m_due += m_options.interval;
  return bytes(m_repeats, '2');
}

std::string TypedKeyboard::bytes(Key key, char action) const {
  const auto arrow = [&](char final) {
    const std::string modifiers = m_options.kitty ? std::string("1;1:") + action : "";
    return "\033[" + modifiers + final;
  };
  const auto character = [&](char ch) {
    if (!m_options.kitty) return std::string(1, ch);
    return "\033[" + std::to_string(static_cast<int>(ch)) + ";1:" + action + "u";
  };
  switch (key) {
    case Key::UPARROW:
      return arrow('A');
    case Key::DOWNARROW:
      return arrow('B');
    case Key::RIGHTARROW:
      return arrow('C');
    case Key::LEFTARROW:
      return arrow('D');
    case Key::SPACE:
      return character(' ');
    case Key::X:
      return character('x');
    default:
      throw std::invalid_argument("not a key of this keyboard");
  }
}

}  // namespace naiad
