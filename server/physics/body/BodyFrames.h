// Pictures of shapes in characters: one, or as many as make up a turn.
//
// A cell is 1 wide and `aspect` high in the metric in which shapes live, so that a square that turns stays a
// square on the screen. The pictures are drawn around the cell nearest to the body's place.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/body/BodyDrawing.h"
#include "physics/geometry/ConvexShape.h"
#include "shared/replica/Look.h"
#include "shared/values/Color.h"

namespace naiad::physics {

struct FrameStyle {
  df::BodyDrawing how = df::BodyDrawing::OUTLINE;
  char32_t ch = 0;  ///< of outline and filling; 0: lines by the direction of the edge, # for a filling
  df::Color color = df::COLOR_DEFAULT;
  std::vector<std::u32string> rows;  ///< of a sprite, around its middle; blanks are holes
  bool spoke = false;                ///< circles show how they are turned
};

/// The character of a line that runs so, in cells. The borders are at 22.5° and 67.5°.
char32_t lineAlong(Vec2 direction, double aspect);

/// The shapes, turned, as they look in character cells.
Appearance drawShapes(std::span<const ConvexShape> shapes, Rotation rotation, double aspect,
                      const FrameStyle& style);

struct TurnFrames {
  Sequence frames;
  std::uint32_t repeats = 1;  ///< how often the sequence is shown in a whole turn
};
/// A turn, in steps by which no edge moves by more than half the width of a cell, unless that takes more than
/// what a look may have. Shapes that look the same after a part of a turn have frames for that part alone.
TurnFrames drawTurn(std::span<const ConvexShape> shapes, double aspect, const FrameStyle& style);

/// In what part of a turn, 1/n, does it come to look as it did? 1 for most, 0 for a circle about the origin.
std::uint32_t symmetryOf(std::span<const ConvexShape> shapes);

}  // namespace naiad::physics
