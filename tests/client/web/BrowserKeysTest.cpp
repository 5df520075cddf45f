#include <gtest/gtest.h>

#include "client/web/BrowserKeys.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using Action = KeyEvent::Action;

KeyEvent press(BrowserKeys& keys, std::string_view key, std::string_view code) {
  return keys.translate(key, code, Action::kPress, 0);
}

TEST(BrowserKeys, MapToTerminalKeys) {
  BrowserKeys keys;
  const struct {
    const char* key;
    const char* code;
    Key expected;
    char32_t ch;
  } kCases[] = {
      {"ArrowLeft", "ArrowLeft", LEFTARROW, 0},
      {"Enter", "NumpadEnter", RETURN, 0},
      {" ", "Space", SPACE, U' '},
      {"a", "KeyA", A, U'a'},
      {"A", "KeyA", A, U'A'},
      {"q", "KeyA", Q, U'q'},
      {"!", "Digit1", NUM1, U'!'},
      {"7", "Numpad7", NUM7, U'7'},
      {"F12", "F12", F12, 0},
      {"Shift", "ShiftRight", RIGHTSHIFT, 0},
      {"Control", "ControlLeft", LEFTCONTROL, 0},
      {"?", "Minus", SLASH, U'?'},
      {"ß", "Minus", UNDEFINED_KEY, U'ß'},
      {"Escape", "Escape", ESCAPE, 0},
  };
  for (const auto& one : kCases) {
    const KeyEvent event = press(keys, one.key, one.code);
    EXPECT_EQ(event.key, one.expected) << one.key;
    EXPECT_EQ(event.ch, one.ch) << one.key;
    keys.translate(one.key, one.code, Action::kRelease, 0);
  }
}

TEST(BrowserKeys, UnknownKeysAreUndefined) {
  BrowserKeys keys;
  for (const char* key : {"AudioVolumeUp", "Unidentified", "", "\xff", "ab", "F25"})
    EXPECT_EQ(press(keys, key, "X").key, UNDEFINED_KEY) << key;
  EXPECT_EQ(press(keys, std::string(1000, 'a'), "KeyA").key, UNDEFINED_KEY);
}

TEST(BrowserKeys, ReleaseUsesTheKeyThatWasPressed) {
  BrowserKeys keys;
  EXPECT_EQ(press(keys, "?", "Digit7").key, SLASH);
  EXPECT_EQ(keys.translate("7", "Digit7", Action::kRepeat, 0).key, SLASH);
  EXPECT_EQ(keys.translate("7", "Digit7", Action::kRelease, 0).key, SLASH);
  EXPECT_EQ(keys.translate("7", "Digit7", Action::kRelease, 0).key, NUM7);
}

TEST(BrowserKeys, MemoryIsBounded) {
  BrowserKeys keys;
  for (int i = 0; i < 10000; ++i) press(keys, "a", "Code" + std::to_string(i));
  EXPECT_EQ(keys.translate("b", "Code0", Action::kRelease, 0).key, A);
  EXPECT_EQ(keys.translate("b", "Code9999", Action::kRelease, 0).key, B);
}

}  // namespace
}  // namespace naiad
