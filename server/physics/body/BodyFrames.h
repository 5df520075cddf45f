// Draws shapes with characters: one frame, or all frames of a turn.
//
// In the metric of the shapes a cell is 1 wide and `aspect` high, so that a rotated square looks square on
// the screen. Frames are drawn around the cell nearest to the body's position.
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
  char32_t ch = 0;  ///< character for outline and filling; 0: lines by their direction, # for filling
  df::Color color = df::COLOR_DEFAULT;
  std::vector<std::u32string> rows;  ///< rows of a sprite, centred; blanks are transparent
  bool spoke = false;                ///< draws a radius in circles, which shows the angle
};

/// Returns the character for a line in this direction (in cells). The characters change at 22.5° and 67.5°.
char32_t lineAlong(Vec2 direction, double aspect);

/// Draws the rotated shapes in character cells.
Appearance drawShapes(std::span<const ConvexShape> shapes, Rotation rotation, double aspect,
                      const FrameStyle& style);

struct TurnFrames {
  Sequence frames;
  std::uint32_t repeats = 1;  ///< number of repetitions of the sequence in a whole turn
};
/// Draws a whole turn in steps. In a step no edge moves by more than half a cell width, unless that exceeds a
/// look's size limit or kMaxFrames. For shapes with rotational symmetry, the frames show a part of the turn.
TurnFrames drawTurn(std::span<const ConvexShape> shapes, double aspect, const FrameStyle& style);

/// Returns n if the shapes look equal after 1/n of a turn: mostly 1; 0 for a circle about the origin.
std::uint32_t symmetryOf(std::span<const ConvexShape> shapes);

}  // namespace naiad::physics
