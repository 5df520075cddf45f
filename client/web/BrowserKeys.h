// Translates a browser's keys (UI Events, KeyboardEvent) into those of a terminal.
//
// `key` is the meaning of a key in the player's layout ("a", "A", "ArrowLeft"), `code` its position ("KeyA",
// "ShiftRight"). Games need the character, so `key` decides, but the position decides for letters of other
// scripts than Latin. A key is released as the key that was pressed, even if Shift was released in between:
// `code` identifies it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "client/terminal/InputDecoder.h"

namespace naiad {

class BrowserKeys {
 public:
  /// Maximum number of remembered held keys. The release of a further key may be reported as another key.
  static constexpr std::size_t kMaxDown = 32;
  /// Limit on the bytes of `key` and `code`; longer ones are unknown keys.
  static constexpr std::size_t kMaxName = 32;

  /// Returns the event for the client. For unknown keys, its key is undefined and it has no character.
  KeyEvent translate(std::string_view key, std::string_view code, KeyEvent::Action action,
                     std::uint8_t modifiers);
  /// Call when the page has lost the keyboard: forgets all keys held down.
  void forget() { m_down.clear(); }

 private:
  std::map<std::string, df::Keyboard::Key, std::less<>> m_down;  ///< indexed by `code`
};

}  // namespace naiad
