#include "client/terminal/KeyTable.h"

#include <array>
#include <string_view>

namespace naiad {

using namespace df::Keyboard;

KeyEvent keyOfCharacter(char32_t ch) {
  KeyEvent event;
  event.ch = ch;
  const auto found = [&event](int key, bool shifted) {
    event.key = static_cast<Key>(key);
    if (shifted) event.modifiers = kShift;
  };
  if (ch >= U'a' && ch <= U'z') {
    found(A + static_cast<int>(ch - U'a'), false);
  } else if (ch >= U'A' && ch <= U'Z') {
    found(A + static_cast<int>(ch - U'A'), true);
  } else if (ch >= U'1' && ch <= U'9') {
    found(NUM1 + static_cast<int>(ch - U'1'), false);
  } else {
    struct Sign {
      char plain;
      char shifted;
      Key key;
    };
    static constexpr std::array<Sign, 22> kSigns = {{
        {' ', ' ', SPACE},       {'0', ')', NUM0},         {'!', '!', NUM1},   {'@', '@', NUM2},
        {'#', '#', NUM3},        {'$', '$', NUM4},         {'%', '%', NUM5},   {'^', '^', NUM6},
        {'&', '&', NUM7},        {'*', '*', NUM8},         {'(', '(', NUM9},   {'-', '_', MINUS},
        {'=', '=', EQUAL},       {'+', '+', PLUS},         {'`', '~', TILDE},  {'.', '>', PERIOD},
        {',', '<', COMMA},       {'/', '?', SLASH},        {'\'', '"', QUOTE}, {';', ':', SEMICOLON},
        {'[', '{', LEFTBRACKET}, {']', '}', RIGHTBRACKET},
    }};
    for (const Sign& sign : kSigns) {
      const bool always_shifted = sign.key >= NUM1 && sign.key <= NUM9;
      if (ch == static_cast<char32_t>(sign.plain)) found(sign.key, always_shifted || ch == U'+');
      if (ch == static_cast<char32_t>(sign.shifted) && sign.plain != sign.shifted) found(sign.key, true);
    }
    if (ch == U'\\' || ch == U'|') found(BACKSLASH, ch == U'|');
  }
  return event;
}

KeyEvent keyOfControl(unsigned char byte) {
  KeyEvent event;
  switch (byte) {
    case 0x09:
      event.key = TAB;
      return event;
    case 0x0A:
    case 0x0D:
      event.key = RETURN;
      return event;
    case 0x1B:
      event.key = ESCAPE;
      return event;
    case 0x08:
    case 0x7F:
      event.key = BACKSPACE;
      return event;
    default:
      break;
  }
  // Control clears the bits 0x60 of the character.
  event = keyOfCharacter(byte == 0      ? U' '
                         : byte <= 0x1A ? static_cast<char32_t>(byte + 0x60)
                                        : static_cast<char32_t>(byte + 0x40));
  event.ch = 0;
  event.modifiers = kControl;
  return event;
}

Key keyOfFinal(char final, bool ss3) {
  switch (final) {
    case 'A':
      return UPARROW;
    case 'B':
      return DOWNARROW;
    case 'C':
      return RIGHTARROW;
    case 'D':
      return LEFTARROW;
    case 'E':
      return UNDEFINED_KEY;  // the keypad's centre
    case 'F':
      return END;
    case 'H':
      return HOME;
    case 'P':
      return F1;
    case 'Q':
      return F2;
    case 'R':
      return F3;
    case 'S':
      return F4;
    case 'a':
      return UPARROW;  // rxvt: lower case with shift (CSI) or control (SS3)
    case 'b':
      return DOWNARROW;
    case 'c':
      return RIGHTARROW;
    case 'd':
      return LEFTARROW;
    case 'Z':
      return ss3 ? UNDEFINED_KEY : TAB;  // CSI Z: shift and Tab
    default:
      break;
  }
  if (!ss3) return UNDEFINED_KEY;
  switch (final) {  // application keypad
    case 'M':
      return RETURN;
    case 'I':
      return TAB;
    case 'X':
      return EQUAL;
    case 'j':
      return NUM8;  // the asterisk
    case 'k':
      return PLUS;
    case 'l':
      return COMMA;
    case 'm':
      return MINUS;
    case 'n':
      return PERIOD;
    case 'o':
      return SLASH;
    case 'p':
      return NUM0;
    default:
      break;
  }
  if (final >= 'q' && final <= 'y') return static_cast<Key>(NUM1 + (final - 'q'));
  return UNDEFINED_KEY;
}

Key keyOfTilde(int number) {
  switch (number) {
    case 1:
    case 7:
      return HOME;
    case 2:
      return INSERT;
    case 3:
      return DELETE;
    case 4:
    case 8:
      return END;
    case 5:
      return PAGEUP;
    case 6:
      return PAGEDOWN;
    default:
      break;
  }
  if (number >= 11 && number <= 15) return static_cast<Key>(F1 + (number - 11));
  if (number >= 17 && number <= 21) return static_cast<Key>(F6 + (number - 17));
  if (number == 23 || number == 24) return static_cast<Key>(F11 + (number - 23));
  return UNDEFINED_KEY;
}

Key keyOfKitty(int code) {
  if (code > 0 && (code < 0x20 || code == 0x7F)) {
    const KeyEvent event = keyOfControl(static_cast<unsigned char>(code));
    return event.modifiers == 0 ? event.key : UNDEFINED_KEY;
  }
  if (code < 0x7F) return keyOfCharacter(static_cast<char32_t>(code)).key;
  if (code >= 57399 && code <= 57408) return code == 57399 ? NUM0 : static_cast<Key>(NUM1 + (code - 57400));
  // From 57409 on: the rest of the keypad.
  static constexpr std::array kKeypad = {PERIOD, SLASH,    NUM8,      MINUS,      PLUS,    RETURN,
                                         EQUAL,  PERIOD,   LEFTARROW, RIGHTARROW, UPARROW, DOWNARROW,
                                         PAGEUP, PAGEDOWN, HOME,      END,        INSERT,  DELETE};
  if (code >= 57409 && code <= 57426) return kKeypad[static_cast<std::size_t>(code - 57409)];
  switch (code) {
    case 57362:
      return PAUSE;
    case 57441:
      return LEFTSHIFT;
    case 57442:
      return LEFTCONTROL;
    case 57443:
      return LEFTALT;
    case 57447:
      return RIGHTSHIFT;
    case 57448:
      return RIGHTCONTROL;
    case 57449:
      return RIGHTALT;
    default:
      return UNDEFINED_KEY;
  }
}

char32_t characterOfKeypad(int code) {
  static constexpr std::string_view kTyped = "0123456789./*-+";
  if (code >= 57399 && code < 57399 + static_cast<int>(kTyped.size())) {
    return static_cast<char32_t>(kTyped[static_cast<std::size_t>(code - 57399)]);
  }
  return code == 57415 ? U'=' : 0;
}

}  // namespace naiad
