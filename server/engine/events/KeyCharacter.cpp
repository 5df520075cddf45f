#include "engine/events/KeyCharacter.h"

namespace df {

namespace {

struct Typed {
  Keyboard::Key key;
  const char* name;
  char plain;
  char shifted;
};

constexpr Typed kTyped[] = {{Keyboard::SPACE, "space", ' ', ' '},
                            {Keyboard::RETURN, "return", 0, 0},
                            {Keyboard::ESCAPE, "escape", 0, 0},
                            {Keyboard::TAB, "tab", 0, 0},
                            {Keyboard::LEFTARROW, "left-arrow", 0, 0},
                            {Keyboard::RIGHTARROW, "right-arrow", 0, 0},
                            {Keyboard::UPARROW, "up-arrow", 0, 0},
                            {Keyboard::DOWNARROW, "down-arrow", 0, 0},
                            {Keyboard::PAUSE, "pause", 0, 0},
                            {Keyboard::MINUS, "minus", '-', '_'},
                            {Keyboard::PLUS, "plus", '+', '+'},
                            {Keyboard::TILDE, "tilde", '~', '~'},
                            {Keyboard::PERIOD, "period", '.', '>'},
                            {Keyboard::COMMA, "comma", ',', '<'},
                            {Keyboard::SLASH, "slash", '/', '?'},
                            {Keyboard::LEFTCONTROL, "left-control", 0, 0},
                            {Keyboard::RIGHTCONTROL, "right-control", 0, 0},
                            {Keyboard::LEFTSHIFT, "left-shift", 0, 0},
                            {Keyboard::RIGHTSHIFT, "right-shift", 0, 0},
                            {Keyboard::BACKSPACE, "backspace", 0, 0},
                            {Keyboard::QUOTE, "quote", '\'', '"'},
                            {Keyboard::SEMICOLON, "semicolon", ';', ':'},
                            {Keyboard::LEFTBRACKET, "left-bracket", '[', '{'},
                            {Keyboard::RIGHTBRACKET, "right-bracket", ']', '}'},
                            {Keyboard::BACKSLASH, "backslash", '\\', '|'},
                            {Keyboard::EQUAL, "equal", '=', '+'},
                            {Keyboard::LEFTALT, "left-alt", 0, 0},
                            {Keyboard::RIGHTALT, "right-alt", 0, 0},
                            {Keyboard::INSERT, "insert", 0, 0},
                            {Keyboard::DELETE, "delete", 0, 0},
                            {Keyboard::HOME, "home", 0, 0},
                            {Keyboard::END, "end", 0, 0},
                            {Keyboard::PAGEUP, "page-up", 0, 0},
                            {Keyboard::PAGEDOWN, "page-down", 0, 0},
                            {Keyboard::MULTIPLY, "multiply", '*', '*'},
                            {Keyboard::QMARK, "question-mark", '?', '?'},
                            {Keyboard::GRAVE, "grave", '`', '~'}};

const Typed* typed(Keyboard::Key key) {
  for (const Typed& one : kTyped) {
    if (one.key == key) return &one;
  }
  return nullptr;
}

bool isLetter(Keyboard::Key key) {
  return key >= Keyboard::A && key <= Keyboard::Z;
}

bool isDigit(Keyboard::Key key) {
  return key >= Keyboard::NUM1 && key <= Keyboard::NUM0;
}

}  // namespace

char characterOf(Keyboard::Key key, bool shift) {
  constexpr const char* kShiftedDigits = "!@#$%^&*()";
  if (isLetter(key)) return static_cast<char>((shift ? 'A' : 'a') + (key - Keyboard::A));
  if (isDigit(key)) {
    const int i = key - Keyboard::NUM1;
    return shift ? kShiftedDigits[i] : static_cast<char>('0' + (i + 1) % 10);
  }
  const Typed* p_typed = typed(key);
  if (p_typed == nullptr) return 0;
  return shift ? p_typed->shifted : p_typed->plain;
}

std::string nameOfKey(Keyboard::Key key) {
  if (isLetter(key) || isDigit(key)) return std::string(1, characterOf(key, false));
  if (key >= Keyboard::F1 && key <= Keyboard::F12) {
    std::string name = "f";
    return name += std::to_string(key - Keyboard::F1 + 1);
  }
  const Typed* p_typed = typed(key);
  return p_typed != nullptr ? p_typed->name : "undefined";
}

}  // namespace df
