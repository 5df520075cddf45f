#include "client/web/BrowserKeys.h"

#include <algorithm>
#include <array>

#include "client/terminal/KeyTable.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/Canvas.h"

namespace naiad {

using namespace df::Keyboard;

namespace {

struct Named {
  std::string_view name;
  Key key;
};

/// Values of `key` that are names rather than characters.
constexpr std::array kNames = {
    Named{"ArrowLeft", LEFTARROW},
    Named{"ArrowRight", RIGHTARROW},
    Named{"ArrowUp", UPARROW},
    Named{"ArrowDown", DOWNARROW},
    Named{"Enter", RETURN},
    Named{"Escape", ESCAPE},
    Named{"Tab", TAB},
    Named{"Backspace", BACKSPACE},
    Named{"Delete", DELETE},
    Named{"Insert", INSERT},
    Named{"Home", HOME},
    Named{"End", END},
    Named{"PageUp", PAGEUP},
    Named{"PageDown", PAGEDOWN},
    Named{"Pause", PAUSE},
};

/// Keys that exist on the left and on the right: only `code` tells them apart.
constexpr std::array kSides = {
    Named{"ShiftLeft", LEFTSHIFT},       Named{"ShiftRight", RIGHTSHIFT}, Named{"ControlLeft", LEFTCONTROL},
    Named{"ControlRight", RIGHTCONTROL}, Named{"AltLeft", LEFTALT},       Named{"AltRight", RIGHTALT},
};

template <class Table>
Key find(const Table& table, std::string_view name) {
  const auto found =
      std::find_if(table.begin(), table.end(), [name](const Named& named) { return named.name == name; });
  return found != table.end() ? found->key : UNDEFINED_KEY;
}

Key functionKey(std::string_view number) {
  const auto n = readNumber(number, 1, 12);
  return n && number[0] != '0' ? static_cast<Key>(F1 + *n - 1) : UNDEFINED_KEY;
}

KeyEvent keyOf(std::string_view key, std::string_view code) {
  KeyEvent event;
  event.key = find(kSides, code);
  if (event.key == UNDEFINED_KEY) event.key = find(kNames, key);
  if (event.key == UNDEFINED_KEY && key.starts_with('F')) event.key = functionKey(key.substr(1));
  if (event.key != UNDEFINED_KEY) return event;
  // The remaining keys type one character; names have several letters.
  const std::u32string characters = df::decodeUtf8(std::string(key));
  if (characters.size() != 1) return event;
  event = keyOfCharacter(characters.front());
  // Greek, Cyrillic and the scripts after them; their letters go by position.
  const bool is_letter_key = code.size() == 4 && code.starts_with("Key") && code[3] >= 'A' && code[3] <= 'Z';
  if (characters.front() >= U'\u0370' && is_letter_key) event.key = static_cast<Key>(A + (code[3] - 'A'));
  return event;
}

}  // namespace

KeyEvent BrowserKeys::translate(std::string_view key, std::string_view code, KeyEvent::Action action,
                                std::uint8_t modifiers) {
  KeyEvent event;
  if (key.size() <= kMaxName && code.size() <= kMaxName) event = keyOf(key, code);
  event.action = action;
  event.modifiers = modifiers;
  const auto down = m_down.find(code);
  if (action == KeyEvent::Action::kPress && event.key != UNDEFINED_KEY && m_down.size() < kMaxDown) {
    m_down.insert_or_assign(std::string(code), event.key);
  } else if (action != KeyEvent::Action::kPress && down != m_down.end()) {
    event.key = down->second;
    if (action == KeyEvent::Action::kRelease) m_down.erase(down);
  }
  return event;
}

}  // namespace naiad
