#include "client/terminal/KeyTable.h"

#include <array>
#include <string_view>

namespace naiad {

using namespace df::Keyboard;

namespace {

constexpr std::array kControls = {BACKSPACE, TAB, RETURN, RETURN, ESCAPE, BACKSPACE};

constexpr Key kNone = UNDEFINED_KEY;

/// Returns the key at an index of a table; undefined if the table has no such index.
template <std::size_t N>
Key keyAt(const std::array<Key, N>& keys, int place) {
  return place >= 0 && place < static_cast<int>(N) ? keys[static_cast<std::size_t>(place)] : kNone;
}
/// Returns the key at the index of `code` in `codes`; undefined if it is not there.
template <std::size_t N>
Key keyIn(std::string_view codes, const std::array<Key, N>& keys, int code) {
  return keyAt(keys, code > 0xFF ? -1 : static_cast<int>(codes.find(static_cast<char>(code))));
}
Key keyOfDigit(int digit) {
  return digit == 0 ? NUM0 : static_cast<Key>(NUM1 + (digit - 1));
}

/// Returns the key that types a Cyrillic or Greek letter in the standard layouts; undefined for other
/// characters.
KeyEvent keyByPosition(char32_t letter) {
  static constexpr std::u32string_view kLetters =
      U"йцукенгшщзхъфывапролджэячсмитьбюёіїєґўςερτυθιοπασδφγηξκλζχψωβνμ";
  static constexpr std::string_view kLatin =
      "qwertyuiop[]asdfghjkl;'zxcvbnm,.`s]'\\owertyuiopasdfghjklzxcvbnm";
  static_assert(kLetters.size() == kLatin.size());
  const bool is_upper = (letter >= U'Α' && letter <= U'Ω') || (letter >= U'Ѐ' && letter <= U'Я');
  const char32_t step = !is_upper ? 0U : letter >= U'Ѐ' && letter <= U'Џ' ? 0x50U : 0x20U;
  const std::size_t place = kLetters.find(letter + step);
  KeyEvent event;
  if (place < kLatin.size()) event = keyOfCharacter(static_cast<unsigned char>(kLatin[place]));
  if (is_upper) event.modifiers = kShift;
  event.ch = letter;
  return event;
}

}  // namespace

KeyEvent keyOfCharacter(char32_t ch) {
  // Characters that the keys type, plain and with shift. 0x7F stands for no character.
  static constexpr std::string_view kPlain = " 0123456789-=`.,/';[]\\\x7F";
  static constexpr std::string_view kShifted = " )!@#$%^&*(_\x7F~><?\":{}|+";
  static constexpr std::array kKeys = {
      SPACE, NUM0,  NUM1,   NUM2,  NUM3,  NUM4,  NUM5,      NUM6,        NUM7,         NUM8,      NUM9, MINUS,
      EQUAL, TILDE, PERIOD, COMMA, SLASH, QUOTE, SEMICOLON, LEFTBRACKET, RIGHTBRACKET, BACKSLASH, PLUS};
  static_assert(kPlain.size() == kKeys.size() && kShifted.size() == kKeys.size());
  KeyEvent event;
  event.ch = ch;
  if (ch >= 0x7F) return keyByPosition(ch);
  const int code = static_cast<int>(ch);
  event.key = code >= 'a' && code <= 'z' ? static_cast<Key>(A + (code - 'a')) : keyIn(kPlain, kKeys, code);
  if (event.key != kNone) return event;
  event.key = code >= 'A' && code <= 'Z' ? static_cast<Key>(A + (code - 'A')) : keyIn(kShifted, kKeys, code);
  if (event.key != kNone) event.modifiers = kShift;
  return event;
}

KeyEvent keyOfControl(unsigned char byte) {
  KeyEvent event;
  event.key = keyIn("\x08\x09\x0A\x0D\x1B\x7F", kControls, byte);
  if (event.key != kNone) return event;
  // Control clears the bits 0x60 of the character.
  event = keyOfCharacter(byte == 0      ? U' '
                         : byte <= 0x1A ? static_cast<char32_t>(byte + 0x60)
                                        : static_cast<char32_t>(byte + 0x40));
  event.ch = 0;
  event.modifiers = kControl;
  return event;
}

Key keyOfFinal(char final, bool ss3) {
  static constexpr std::array kKeys = {UPARROW, DOWNARROW, RIGHTARROW, LEFTARROW, END, HOME, F1, F2, F3, F4};
  // rxvt writes cursor keys in lower case with shift (CSI) or control (SS3).
  const char upper = final >= 'a' && final <= 'd' ? static_cast<char>(final - 'a' + 'A') : final;
  const Key key = keyIn("ABCDFHPQRS", kKeys, upper);
  if (key != kNone) return key;
  if (!ss3) return final == 'Z' ? TAB : kNone;  // shift and Tab
  if (final >= 'q' && final <= 'y') return static_cast<Key>(NUM1 + (final - 'q'));
  static constexpr std::array kKeypad = {RETURN, TAB, EQUAL, NUM8, PLUS, COMMA, MINUS, PERIOD, SLASH, NUM0};
  return keyIn("MIXjklmnop", kKeypad, final);
}

Key keyOfTilde(int number) {
  static constexpr std::array kKeys = {kNone, HOME,  INSERT, DELETE, END,   PAGEUP, PAGEDOWN, HOME,  END,
                                       kNone, kNone, F1,     F2,     F3,    F4,     F5,       kNone, F6,
                                       F7,    F8,    F9,     F10,    kNone, F11,    F12};
  return keyAt(kKeys, number);
}

Key keyOfKitty(int code) {
  if (code > 0 && (code < 0x20 || code == 0x7F)) {
    const KeyEvent event = keyOfControl(static_cast<unsigned char>(code));
    return event.modifiers == 0 ? event.key : kNone;
  }
  if (code < 57344) return keyOfCharacter(static_cast<char32_t>(code)).key;
  if (code == 57362) return PAUSE;
  if (code >= 57399 && code <= 57408) return keyOfDigit(code - 57399);
  // The other keys of the keypad have the codes from 57409.
  static constexpr std::array kKeypad = {PERIOD, SLASH,    NUM8,      MINUS,      PLUS,    RETURN,
                                         EQUAL,  PERIOD,   LEFTARROW, RIGHTARROW, UPARROW, DOWNARROW,
                                         PAGEUP, PAGEDOWN, HOME,      END,        INSERT,  DELETE};
  // Modifiers have the codes from 57441. Super, Hyper and Meta are not keys of the game.
  static constexpr std::array kModifiers = {LEFTSHIFT, LEFTCONTROL, LEFTALT,      kNone,   kNone,
                                            kNone,     RIGHTSHIFT,  RIGHTCONTROL, RIGHTALT};
  return code < 57441 ? keyAt(kKeypad, code - 57409) : keyAt(kModifiers, code - 57441);
}

Key keyOfWindows(int virtual_key, int scan_code, bool enhanced) {
  constexpr int kRightShift = 0x36;
  if (virtual_key >= 'A' && virtual_key <= 'Z') return static_cast<Key>(A + (virtual_key - 'A'));
  if (virtual_key >= 0x70 && virtual_key <= 0x7B) return static_cast<Key>(F1 + (virtual_key - 0x70));
  if (virtual_key >= '0' && virtual_key <= '9') return keyOfDigit(virtual_key - '0');
  if (virtual_key >= 0x60 && virtual_key <= 0x69) return keyOfDigit(virtual_key - 0x60);
  if (virtual_key == 0x10 && scan_code == kRightShift) return RIGHTSHIFT;
  if (virtual_key == 0x11 && enhanced) return RIGHTCONTROL;
  if (virtual_key == 0x12 && enhanced) return RIGHTALT;
  static constexpr std::string_view kCodes =
      "\x08\x09\x0D\x10\x11\x12\x13\x1B\x20\x21\x22\x23\x24\x25\x26\x27\x28\x2D\x2E"
      "\x6A\x6B\x6D\x6E\x6F\xBA\xBB\xBC\xBD\xBE\xBF\xC0\xDB\xDC\xDD\xDE";
  static constexpr std::array kKeys = {
      BACKSPACE, TAB,      RETURN, LEFTSHIFT, LEFTCONTROL, LEFTALT,   PAUSE,        ESCAPE,    SPACE,
      PAGEUP,    PAGEDOWN, END,    HOME,      LEFTARROW,   UPARROW,   RIGHTARROW,   DOWNARROW, INSERT,
      DELETE,    NUM8,     PLUS,   MINUS,     PERIOD,      SLASH,     SEMICOLON,    EQUAL,     COMMA,
      MINUS,     PERIOD,   SLASH,  TILDE,     LEFTBRACKET, BACKSLASH, RIGHTBRACKET, QUOTE};
  static_assert(kCodes.size() == kKeys.size());
  return keyIn(kCodes, kKeys, virtual_key);
}

char32_t characterOfKeypad(int code) {
  static constexpr std::string_view kTyped = "0123456789./*-+";
  if (code >= 57399 && code < 57399 + static_cast<int>(kTyped.size())) {
    return static_cast<char32_t>(kTyped[static_cast<std::size_t>(code - 57399)]);
  }
  return code == 57415 ? U'=' : 0;
}

}  // namespace naiad
