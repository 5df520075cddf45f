// The contact of two bodies that do not rotate, and when they will touch next.
//
// This is the time of impact of axis-aligned boxes and circles under constant accelerations. The gap is a
// polynomial of time of degree at most four (PolynomialRoots.h), so the moment is exact to rounding, as an
// event queue needs it. TimeOfImpact.h only finds a safe moment near it, and on straight paths.
#pragma once

#include "physics/impact/ImpactBody.h"

namespace naiad::physics {

/// Metric cells: overlap up to this depth does not count; a quarter of the world's unit (2^-32 cell). Grazing
/// contacts of less depth are ignored, so that a body sliding over the seam of two tiles hits no edge.
inline constexpr double kImpactSlop = 0x1p-34;

/// Motion of a second body relative to a first, from a given moment on.
struct RelativeMotion {
  Vec2 offset;  ///< displacement from the first body to the second
  Vec2 velocity;
  Vec2 acceleration;
};

/// The axis along which two boxes touch. kNearest: chosen by their positions, also for other shapes.
enum class ImpactAxis : std::uint8_t { kNearest, kX, kY };

/// The contact geometry at a moment.
struct ImpactTouch {
  Vec2 normal;           ///< direction from the first body to the second
  double gap;            ///< distance of the surfaces along the normal; negative: overlap
  double curvature = 0;  ///< 1 / distance of the centres about which the normal turns; 0 if flat
  double overlap = 1;    ///< for boxes, across the normal: how far they can slide until they lose contact
};

ImpactTouch touchOf(const ImpactBody& a, const ImpactBody& b, Vec2 offset,
                    ImpactAxis axis = ImpactAxis::kNearest);

/// Returns the relative speed (cells per tick) below which a speed counts as zero, as it is only rounding.
inline double restSpeed(Vec2 velocity_a, Vec2 velocity_b) {
  return 1e-12 + 2e-15 * (std::fabs(velocity_a.x) + std::fabs(velocity_a.y) + std::fabs(velocity_b.x) +
                          std::fabs(velocity_b.y));
}

/// The next contact of a pair.
struct ImpactForecast {
  double time = -1;  ///< time since the moment of `motion`; −1: no contact until the horizon
  ImpactAxis axis = ImpactAxis::kNearest;
};

/// Returns the first moment in [0, horizon] at which the bodies touch and move into each other; 0 if they
/// touch now and approach faster than `rest_speed`. With `is_resting`, one lies on the other already, and
/// only an overlap deeper than the slop counts. Bodies that overlap at the start may only separate.
ImpactForecast forecastImpact(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& motion,
                              double horizon, double rest_speed, bool is_resting);

/// Returns when a resting contact changes its kind, because a box leaves the edge, or a circle moves from a
/// face to a corner or back. −1: not until the horizon.
double forecastEdge(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& motion, ImpactAxis axis,
                    double horizon);

}  // namespace naiad::physics
