// The ways in which a Body can be drawn (Body::setDrawing).
#pragma once

#include <cstdint>

namespace df {

// GCC's -Wshadow reports scoped enumerators whose names are also plain ones, here df::NONE.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"

/// A way to draw a Body.
enum class BodyDrawing : std::uint8_t {
  NONE,     ///< not drawn
  OUTLINE,  ///< the edge; by default with the characters - / | and \, by its direction
  FILL,     ///< all cells whose centre the body covers
  SPRITE,   ///< rows of characters that turn with the body
};

#pragma GCC diagnostic pop

}  // namespace df
