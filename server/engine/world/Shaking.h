// The window shakes (DM.shake): by how many cells the picture is off its place in a tick.
#pragma once

#include "engine/world/Random.h"

namespace df {

struct Shaking {
  int scale_x = 0;  ///< at most so many cells to either side
  int scale_y = 0;
  int ticks = 0;  ///< that are left
  int x = 0;      ///< in this tick
  int y = 0;

  void step(Random& random) {
    x = y = 0;
    if (ticks <= 0) return;
    --ticks;
    x = random.below(2 * scale_x + 1) - scale_x;
    y = random.below(2 * scale_y + 1) - scale_y;
  }
};

}  // namespace df
