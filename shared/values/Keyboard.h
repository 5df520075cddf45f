// Keys and mouse buttons: names for games and numbers on the wire (Dragonfly book, Listings 4.84 to 4.88).
// Their type is int, so that any number can be cast to them and compared with the known ones.
#pragma once

#include "detail/LanguageStandard.h"

namespace df {

namespace Keyboard {

/// Keys by name. Values are fixed: they travel on the wire; new ones are added at the end.
enum Key : int {
  UNDEFINED_KEY = -1,
  SPACE = 0,
  RETURN,
  ESCAPE,
  TAB,
  LEFTARROW,
  RIGHTARROW,
  UPARROW,
  DOWNARROW,
  PAUSE,
  MINUS,
  PLUS,
  TILDE,
  PERIOD,
  COMMA,
  SLASH,
  LEFTCONTROL,
  RIGHTCONTROL,
  LEFTSHIFT,
  RIGHTSHIFT,
  F1,
  F2,
  F3,
  F4,
  F5,
  F6,
  F7,
  F8,
  F9,
  F10,
  F11,
  F12,
  A,
  B,
  C,
  D,
  E,
  F,
  G,
  H,
  I,
  J,
  K,
  L,
  M,
  N,
  O,
  P,
  Q,
  R,
  S,
  T,
  U,
  V,
  W,
  X,
  Y,
  Z,
  NUM1,
  NUM2,
  NUM3,
  NUM4,
  NUM5,
  NUM6,
  NUM7,
  NUM8,
  NUM9,
  NUM0,
  BACKSPACE,
  QUOTE,
  SEMICOLON,
  LEFTBRACKET,
  RIGHTBRACKET,
  BACKSLASH,
  EQUAL,
  LEFTALT,
  RIGHTALT,
  INSERT,
  DELETE,
  HOME,
  END,
  PAGEUP,
  PAGEDOWN,
  // Names of the published engine for keys that are reported as other keys or not at all: never on the wire.
  MULTIPLY,
  QMARK,
  GRAVE,
  LBRACKET = LEFTBRACKET,
  RBRACKET = RIGHTBRACKET,
};

/// Number of keys that travel on the wire.
inline constexpr int kKeyCount = PAGEDOWN + 1;

}  // namespace Keyboard

/// The action of a key.
enum EventKeyboardAction : int {
  UNDEFINED_KEYBOARD_ACTION = -1,
  KEY_PRESSED = 0,  ///< The key went down.
  KEY_RELEASED,     ///< The key went up.
  KEY_DOWN,         ///< The key is being held (once per tick or key repeat).
};

namespace Mouse {

/// Buttons of a mouse.
enum Button : int {
  UNDEFINED_MOUSE_BUTTON = -1,
  LEFT = 0,
  RIGHT,
  MIDDLE,
};
/// The name of Button in the published engine.
using EventMouseButton = Button;

}  // namespace Mouse

/// The action of the mouse.
enum EventMouseAction : int {
  UNDEFINED_MOUSE_ACTION = -1,
  CLICKED = 0,  ///< A button went down.
  PRESSED,      ///< A button is being held.
  MOVED,        ///< The pointer moved to another cell.
};

}  // namespace df
