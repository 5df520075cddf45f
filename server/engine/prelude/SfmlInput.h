// Stands in for the keys and buttons of the graphics library SFML. No key or button is ever down, because
// players' input comes as events. See Sfml.h.
#pragma once

#include "detail/SfmlValues.h"

namespace sf {

struct Keyboard {
  enum Key {
    Unknown = -1,
    // clang-format off
    A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z,
    Num0, Num1, Num2, Num3, Num4, Num5, Num6, Num7, Num8, Num9,
    Escape, LControl, LShift, LAlt, LSystem, RControl, RShift, RAlt, RSystem, Menu, LBracket, RBracket,
    Semicolon, Comma, Period, Quote, Slash, Backslash, Tilde, Equal, Hyphen, Space, Enter, Backspace, Tab,
    PageUp, PageDown, End, Home, Insert, Delete, Add, Subtract, Multiply, Divide, Left, Right, Up, Down,
    Numpad0, Numpad1, Numpad2, Numpad3, Numpad4, Numpad5, Numpad6, Numpad7, Numpad8, Numpad9,
    F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12, F13, F14, F15, Pause, KeyCount,
    // clang-format on
    Return = Enter,
    BackSpace = Backspace,
  };
  static bool isKeyPressed(Key /*key*/) { return false; }
};

struct Mouse {
  enum Button { Left, Right, Middle, XButton1, XButton2, ButtonCount };
  static bool isButtonPressed(Button /*button*/) { return false; }
  template <class... T>
  static Vector2i getPosition(const T&... /*window*/) {
    return {};
  }
  template <class... T>
  static void setPosition(const Vector2i& /*position*/, const T&... /*window*/) {}
};

}  // namespace sf
