#include "engine/widgets/TextEntry.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "engine/events/KeyCharacter.h"
#include "engine/managers/GameManager.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"

namespace df {

TextEntry::TextEntry() : m_player(World::current().input().player()) {
  Object::setType("TextEntry");
  ViewObject::setDrawValue(false);
  if (World::current().compat()) {
    m_limit = 1;
    m_blink_rate = 10;
  }
  registerInterest(KEYBOARD_EVENT);
}

void TextEntry::setText(std::string new_text) {
  m_text = std::move(new_text);
  m_limit = std::max(m_limit, static_cast<int>(m_text.size()));
  m_cursor = static_cast<int>(m_text.size());
}

void TextEntry::setLimit(int new_limit) {
  m_limit = std::max(0, new_limit);
  if (static_cast<int>(m_text.size()) > m_limit) m_text.resize(static_cast<std::size_t>(m_limit));
  setCursor(m_cursor);
}

void TextEntry::setCursor(int new_cursor) {
  m_cursor = std::clamp(new_cursor, 0, static_cast<int>(m_text.size()));
}

void TextEntry::type(char ch) {
  if (static_cast<int>(m_text.size()) >= m_limit) return;
  if (m_numbers_only && std::isdigit(static_cast<unsigned char>(ch)) == 0) return;
  m_text.insert(m_text.begin() + m_cursor, ch);
  ++m_cursor;
}

bool TextEntry::takesKey(const EventKeyboard& key) const {
  if (m_player == 0 || key.getPlayer() == m_player) return true;
  const World* p_world = getWorld();
  return p_world != nullptr && p_world->views().player(m_player) == nullptr;
}

int TextEntry::eventHandler(const Event* p_e) {
  const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
  if (p_key == nullptr) return ViewObject::eventHandler(p_e);
  if (!takesKey(*p_key)) return 0;
  const Keyboard::Key key = p_key->getKey();
  const EventKeyboardAction action = p_key->getKeyboardAction();
  if (key == Keyboard::LEFTSHIFT || key == Keyboard::RIGHTSHIFT) m_shift = action != KEY_RELEASED;
  if (action != KEY_PRESSED) return 0;
  if (key == Keyboard::RETURN) {
    callback();
  } else if (key == Keyboard::BACKSPACE) {
    if (m_cursor > 0) m_text.erase(m_text.begin() + --m_cursor);
  } else if (key == Keyboard::LEFTARROW || key == Keyboard::RIGHTARROW) {
    setCursor(m_cursor + (key == Keyboard::LEFTARROW ? -1 : 1));
  } else if (const char ch = characterOf(key, m_shift); ch != 0) {
    type(ch);
  } else {
    return 0;
  }
  return 1;
}

int TextEntry::draw() {
  std::string text = m_text;
  const bool shown = m_blink_rate < 1 || GM.getStepCount() / m_blink_rate % 2 == 0;
  text.insert(static_cast<std::size_t>(m_cursor), 1, shown ? m_cursor_char : ' ');
  return drawText(" " + getViewString() + (getViewString().empty() ? "" : " ") + text + " ");
}

}  // namespace df
