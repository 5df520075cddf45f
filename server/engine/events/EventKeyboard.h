// Sent to interested Objects when a player uses a key (book, Listing 4.86).
#pragma once

#include <cstdint>
#include <type_traits>

#include "Event.h"
#include "Keyboard.h"

namespace df {

namespace Keyboard {

/// Compares the numbers, which is a mistake: `getKey() == 'a'` is not the key A. A template, so that
/// comparisons with an int are as without it.
template <class Char, typename std::enable_if<std::is_same<Char, char>::value, int>::type = 0>
__attribute__((deprecated("a key is not a character: write df::Keyboard::A"))) bool operator==(Key key,
                                                                                               Char c) {
  return static_cast<int>(key) == c;
}

}  // namespace Keyboard

/// Register interest in this to get all players' keys.
inline const EventType KEYBOARD_EVENT("df-keyboard");

class EventKeyboard : public Event {
 public:
  EventKeyboard() { setType(KEYBOARD_EVENT); }

  /// The key (book, Listing 4.84).
  void setKey(Keyboard::Key key) { m_key = key; }
  Keyboard::Key getKey() const { return m_key; }
  /// Whether the key went down, is held, or went up.
  void setKeyboardAction(EventKeyboardAction action) { m_action = action; }
  EventKeyboardAction getKeyboardAction() const { return m_action; }

  /// Id of the player that used the key, for `WM.getPlayer()`; 0 if none did (the game made the event
  /// itself). A game that ignores it treats all players' keys alike.
  void setPlayer(std::uint32_t player) { m_player = player; }
  std::uint32_t getPlayer() const { return m_player; }

  /// True if the player's declared controls (Player::setControls) have handled the key, even if a wait or a
  /// wall kept the Object where it is. Then the handler need not move the Object.
  void setHandled(bool handled) { m_handled = handled; }
  bool isHandled() const { return m_handled; }

 private:
  Keyboard::Key m_key = Keyboard::UNDEFINED_KEY;
  EventKeyboardAction m_action = UNDEFINED_KEYBOARD_ACTION;
  std::uint32_t m_player = 0;
  bool m_handled = false;
};

}  // namespace df
