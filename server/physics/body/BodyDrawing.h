// How a Body appears on the screen (Body::setDrawing).
#pragma once

#include <cstdint>

namespace df {

/// How a Body is drawn.
enum class BodyDrawing : std::uint8_t {
  NONE,     ///< nothing
  OUTLINE,  ///< its edge; by default in - / | and \, as the edge runs
  FILL,     ///< all cells whose middle it covers
  SPRITE,   ///< rows of characters that turn with it
};

}  // namespace df
