// How two bodies that do not turn touch, and when they next will.
//
// The time-of-impact finder for axis-aligned boxes and circles under constant accelerations, for any time to
// come. The gap then is a polynomial of time of degree at most four (PolynomialRoots.h), so the moment is
// exact to rounding, as an event queue needs it: TimeOfImpact.h finds a safe moment near it, and on straight
// paths only.
#pragma once

#include "physics/impact/ImpactBody.h"

namespace naiad::physics {

/// Metric cells: how deep bodies may be in one another before it counts, a quarter of the world's unit (2^-32
/// cell). What grazes less deep passes: a body that slides over the seam of two tiles hits no edge.
inline constexpr double kImpactSlop = 0x1p-34;

/// The motion of a second body as seen from a first, from a moment on.
struct RelativeMotion {
  Vec2 offset;  ///< from the first body to the second
  Vec2 velocity;
  Vec2 acceleration;
};

/// The axis along which two boxes touch. Anything else: by where they are.
enum class ImpactAxis : std::uint8_t { kNearest, kX, kY };

/// A moment's geometry.
struct ImpactTouch {
  Vec2 normal;           ///< from the first body to the second
  double gap;            ///< between the surfaces along the normal; negative inside
  double curvature = 0;  ///< one over the distance of the centres that the normal turns about; 0 if flat
  double overlap = 1;    ///< across the normal; boxes: how far they stay over one another
};

ImpactTouch touchOf(const ImpactBody& a, const ImpactBody& b, Vec2 offset,
                    ImpactAxis axis = ImpactAxis::kNearest);

/// Cells per tick. Below this the two neither approach nor part: rounding of their velocities, a few units in
/// the last place.
inline double restSpeed(Vec2 velocity_a, Vec2 velocity_b) {
  return 1e-12 + 2e-15 * (std::fabs(velocity_a.x) + std::fabs(velocity_a.y) + std::fabs(velocity_b.x) +
                          std::fabs(velocity_b.y));
}

/// What comes next for a pair.
struct ImpactForecast {
  double time = -1;  ///< from the moment of `motion`; −1: nothing until the horizon
  ImpactAxis axis = ImpactAxis::kNearest;
};

/// The first moment in [0, horizon] at which the bodies touch and go on into one another; bodies that touch
/// now and approach faster than `rest_speed` do so at 0. `is_resting`: they lie on one another already and
/// only going deeper than the slop counts. Bodies that begin inside one another may part but go no deeper.
ImpactForecast forecastImpact(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& motion,
                              double horizon, double rest_speed, bool is_resting);

/// When a resting contact changes its kind: a box leaves the edge, a circle goes from a face to a corner or
/// back. −1: not until the horizon.
double forecastEdge(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& motion, ImpactAxis axis,
                    double horizon);

}  // namespace naiad::physics
