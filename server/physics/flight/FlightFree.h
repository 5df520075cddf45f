// Flight of an untouched body under a constant force.
//
// All flights are pure functions of the initial state and the time since then, so that a search for an impact
// can evaluate any moment of a tick. They return the displacement since the start instead of a position,
// because it is more exact (Place.h).
#pragma once

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// The result of a flight.
struct Flown {
  Vec2 displacement;  ///< displacement since the start, in metric cells
  Vec2 velocity;      ///< velocity at the end, in metric cells per unit of time
};

/// Computes a flight under a constant `acceleration`; only rounding makes errors.
constexpr Flown flyFree(Vec2 velocity, Vec2 acceleration, double t) {
  return {t * velocity + (0.5 * t * t) * acceleration, velocity + t * acceleration};
}

}  // namespace naiad::physics
