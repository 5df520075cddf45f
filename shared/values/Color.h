// The eight colours of a Dragonfly character (Dragonfly book, Listing 4.66).
#pragma once

#include "detail/LanguageStandard.h"

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
  CUSTOM,  ///< a colour that a game mixes; never on the wire or in a cell
};

/// The colour of characters without a colour.
inline constexpr Color COLOR_DEFAULT = WHITE;
/// The number of colours that a terminal shows.
inline constexpr int kColorCount = 8;

}  // namespace df
