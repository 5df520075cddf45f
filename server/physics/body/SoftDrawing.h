// Soft bodies in characters.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyDrawing.h"
#include "physics/body/Metric.h"
#include "physics/soft/SoftBody.h"
#include "shared/values/Color.h"

namespace naiad::physics {

/// How it is to be drawn, and the picture of it that is on the screen.
struct SoftDrawn {
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    char32_t ch = U' ';
  };

  df::BodyDrawing drawing = df::BodyDrawing::OUTLINE;
  char32_t ch = 0;
  df::Color color = df::COLOR_DEFAULT;

  std::vector<Place> nodes;  ///< when it was drawn
  std::vector<Cell> cells;   ///< by rows, each once
};

/// Draw it again if a node has moved by more than a twentieth of a cell since: so what is at rest looks
/// still.
void redraw(SoftDrawn& drawn, const SoftBody& body, const Metric& metric);
/// Put it on the screen, for the Object whose draw() is running. Return 0, or -1 if some of it is too far
/// away.
int put(const SoftDrawn& drawn);

}  // namespace naiad::physics
