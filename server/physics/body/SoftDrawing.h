// Draws soft bodies with characters.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyDrawing.h"
#include "physics/body/Metric.h"
#include "physics/soft/SoftBody.h"
#include "shared/values/Color.h"

namespace naiad::physics {

/// The style of a soft body's drawing, and the cells last drawn.
struct SoftDrawn {
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    char32_t ch = U' ';
  };

  df::BodyDrawing drawing = df::BodyDrawing::OUTLINE;
  char32_t ch = 0;
  df::Color color = df::COLOR_DEFAULT;

  std::vector<Place> nodes;  ///< positions when it was drawn
  std::vector<Cell> cells;   ///< sorted by rows, without duplicates
};

/// Draws the body's cells again, but only if a node has moved by more than a twentieth of a cell since the
/// last time, so that bodies at rest look still.
void redraw(SoftDrawn& drawn, const SoftBody& body, const Metric& metric);
/// Puts the cells on the screen for the Object whose draw() runs. Returns 0, or -1 if they are too far away.
int put(const SoftDrawn& drawn);

}  // namespace naiad::physics
