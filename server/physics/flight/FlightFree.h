// How a body moves while nothing touches it: under a constant force.
//
// All flights are pure functions of what holds at the start and of the time since then, so that a
// search for an impact may ask for any moment of a tick. They give the displacement since the start instead
// of a position: see Place.h.
#pragma once

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// What a flight has led to.
struct Flown {
  Vec2 displacement;  ///< since the start, metric cells
  Vec2 velocity;      ///< at the end, cells per unit of time
};

/// Under a constant `acceleration`, exact but for rounding.
constexpr Flown flyFree(Vec2 velocity, Vec2 acceleration, double t) {
  return {t * velocity + (0.5 * t * t) * acceleration, velocity + t * acceleration};
}

}  // namespace naiad::physics
