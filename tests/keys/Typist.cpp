#include "Typist.h"

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "engine/world/InputQueue.h"

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

namespace {

bool isArrow(Key key) {
  return key == Key::LEFTARROW || key == Key::RIGHTARROW || key == Key::UPARROW || key == Key::DOWNARROW;
}

}  // namespace

Typist::Typist(df::World& world, std::uint32_t player, const KeyMethod& method,
               TypedKeyboard::Options keyboard)
    : m_world(world),
      m_player(player),
      m_method(method),
      m_keyboard((keyboard.kitty = method.kitty, keyboard)),
      m_held(method.rule) {
  m_held.setRealReleases(method.kitty);
}

void Typist::hold(const std::set<Key>& keys) {
  const std::set<Key> before = m_keyboard.down();
  const bool stops =
      m_method.tap_to_go && std::ranges::any_of(before, isArrow) && std::ranges::none_of(keys, isArrow);
  if (stops) type(m_keyboard.press(Key::X, m_now) + m_keyboard.release(Key::X));
  for (const Key key : before)
    if (!keys.contains(key)) type(m_keyboard.release(key));
  for (const Key key : keys)
    if (!before.contains(key)) type(m_keyboard.press(key, m_now));
}

void Typist::tick() {
  for (Milliseconds passed{}; passed < kTick; ++passed) {
    m_now += Milliseconds(1);
    type(m_keyboard.repeat(m_now));
    take(m_decoder.flush(m_now));
    send(m_held.expire(m_now));
  }
  send(m_held.tick());
  m_world.tick();
}

void Typist::type(const std::string& bytes) {
  if (!bytes.empty()) take(m_decoder.feed(bytes, m_now));
}

void Typist::take(const std::vector<TerminalEvent>& events) {
  for (const TerminalEvent& event : events) {
    const auto* p_key = std::get_if<KeyEvent>(&event);
    if (p_key == nullptr || (m_method.tap_to_go && takeGo(*p_key))) continue;
    send(m_held.handleKey(*p_key, m_now));
  }
}

bool Typist::takeGo(const KeyEvent& event) {
  const Key key = event.key;
  const bool direction = isArrow(key);
  if (!direction && key != Key::X) return false;
  if (m_going == key) return true;
  if (m_going) send({{*m_going, df::KEY_RELEASED}});
  m_going.reset();
  if (!direction) return true;
  m_going = key;
  send({{key, df::KEY_PRESSED}});
  return true;
}

void Typist::send(const std::vector<KeyAction>& actions) {
  for (const KeyAction& action : actions) m_world.input().key(m_player, action.key, action.action);
}

}  // namespace naiad
