// The keys of a browser (UI Events, KeyboardEvent) as those of a terminal.
//
// `key` says what a key means in the player's layout ("a", "A", "ArrowLeft"), `code` where it is ("KeyA",
// "ShiftRight"). Games ask for what a key types, so `key` decides; but a key goes up as what it went down as,
// though Shift may have come up in between: `code` identifies it.
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
  /// Keys that are down at a time; further ones go down but never up.
  static constexpr std::size_t kMaxDown = 32;
  /// Bytes of `key` and `code`; longer ones are unknown keys.
  static constexpr std::size_t kMaxName = 32;

  /// The event for the client; its key is undefined and it types nothing if the client has no such key.
  KeyEvent translate(std::string_view key, std::string_view code, KeyEvent::Action action,
                     std::uint8_t modifiers);
  /// No key is down any more: the page has lost the keyboard.
  void forget() { m_down.clear(); }

 private:
  std::map<std::string, df::Keyboard::Key, std::less<>> m_down;  ///< by code
};

}  // namespace naiad
