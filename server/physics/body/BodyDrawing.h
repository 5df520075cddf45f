// The ways in which a Body can be drawn (Body::setDrawing).
#pragma once

#include <cstdint>

namespace df {

enum class BodyDrawing : std::uint8_t {
  NONE,     ///< not drawn
  OUTLINE,  ///< the edge; by default with - / | and \, by its direction
  FILL,     ///< all cells whose centre it covers
  SPRITE,   ///< rows of characters that turn with it
};

}  // namespace df
