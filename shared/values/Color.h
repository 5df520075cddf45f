// The eight colours of a Dragonfly character (book, Listing 4.66).
#pragma once

#include "detail/Dialect.h"

namespace df {

/// Values are fixed: they travel on the wire.
enum Color {
  UNDEFINED_COLOR = -1,
  BLACK = 0,
  RED,
  GREEN,
  YELLOW,
  BLUE,
  MAGENTA,
  CYAN,
  WHITE,
  CUSTOM,  ///< a mix of red, green and blue, where a game gives one; never on the wire, never in a cell
};

/// What is drawn without a colour.
inline constexpr Color COLOR_DEFAULT = WHITE;
/// Colours that a terminal shows.
inline constexpr int kColorCount = 8;

}  // namespace df
