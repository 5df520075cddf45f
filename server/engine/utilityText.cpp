// The functions of utility.h that are about text.

#include <array>
#include <cctype>
#include <cstdio>
#include <sstream>

#include "ConfigText.h"
#include "GameManager.h"
#include "LogManager.h"
#include "NetworkNode.h"
#include "World.h"
#include "utility.h"

namespace df {

namespace {

template <std::size_t N>
std::string nameAt(const std::array<const char*, N>& names, int index) {
  return index >= 0 && index < static_cast<int>(N) ? names[static_cast<std::size_t>(index)] : "undefined";
}

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

std::string toString(int i) {
  return std::to_string(i);
}

std::string toString(float f) {
  std::ostringstream out;
  out << f;
  return out.str();
}

std::string toString(char c) {
  return std::string(1, c);
}

std::string toString(bool b) {
  return b ? "true" : "false";
}

std::string toString(Color color) {
  return nameAt(std::array{"black", "red", "green", "yellow", "blue", "magenta", "cyan", "white", "custom"},
                color);
}

std::string toString(const Shape& shape) {
  return shape.toString();
}

std::string toString(const Path& path) {
  return path.toString();
}

std::string toString(Keyboard::Key key_val) {
  if (isLetter(key_val) || isDigit(key_val)) return std::string(1, characterOf(key_val, false));
  if (key_val >= Keyboard::F1 && key_val <= Keyboard::F12)
    return "f" + std::to_string(key_val - Keyboard::F1 + 1);
  const Typed* p_typed = typed(key_val);
  return p_typed != nullptr ? p_typed->name : "undefined";
}

std::string toString(Solidness solid) {
  return nameAt(std::array{"hard", "soft", "spectral"}, solid);
}

std::string toString(ViewObjectLocation location) {
  return nameAt(std::array{"top-left", "top-center", "top-right", "center-left", "center-center",
                           "center-right", "bottom-left", "bottom-center", "bottom-right"},
                location);
}

std::string toString(MessageType message) {
  return nameAt(std::array{"sync-object", "delete-object", "game-over", "keyboard-input", "mouse-input",
                           "custom-message"},
                static_cast<int>(message));
}

std::string maskToString(unsigned int mask) {
  std::string text;
  for (unsigned bit = 1u << 31; bit != 0; bit >>= 1) text += (mask & bit) != 0 ? '1' : '0';
  return text;
}

std::string match(const std::string& str, const std::string& find) {
  thread_local std::string last;
  if (!str.empty()) last = str;
  return valueOf(last, find);
}

char* getTimeString() {
  thread_local std::array<char, 32> text;
  const int seconds = GM.getStepCount() / 30;
  std::snprintf(text.data(), text.size(), "%02d:%02d:%02d", seconds / 3600, seconds / 60 % 60, seconds % 60);
  return text.data();
}

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

int stringStreamCheck(const char* prefix, std::stringstream* p_ss) {
  if (p_ss != nullptr && !p_ss->fail()) return 0;
  LM.writeLog("%s: the stream has failed", prefix != nullptr ? prefix : "");
  return -1;
}

}  // namespace df
