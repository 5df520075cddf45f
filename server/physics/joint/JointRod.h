// Two points on a rod: RATTLE in closed form for the smallest island (a pendulum, a dumb-bell).
//
// The centre of mass flies exactly; RATTLE moves the displacement from one end to the other. In the plane
// this has a direction and a rate of turning: half a kick changes the rate, a stage of length h turns by the
// angle whose sine is h · rate, and half a kick follows. (This follows from the position equation.)
#pragma once

#include <cmath>

#include "physics/geometry/Vec2.h"
#include "physics/joint/Joint.h"
#include "physics/joint/JointMethod.h"

namespace naiad::physics {

/// A rod; all vectors are divided by its length.
struct JointRod {
  Vec2 direction;     ///< unit length, from a to b
  double rate = 0;    ///< angular speed of the rod
  Vec2 acceleration;  ///< acceleration of b relative to a, without the rod
  double gain = 0;    ///< change of `rate` by `acceleration`, per unit of time: direction × acceleration
  Vec2 pull;          ///< sum of the rod's impulses on b, divided by the reduced mass

  static constexpr double kMinCosineSquared = 0.01;  ///< a stage turns by less than 84°

  JointRod(Vec2 its_direction, Vec2 velocity, Vec2 its_acceleration)
      : direction(its_direction),
        rate(cross(its_direction, velocity)),
        acceleration(its_acceleration),
        gain(cross(its_direction, its_acceleration)) {}

  Vec2 velocity() const { return rate * perpendicular(direction); }

  /// Advances by a stage of h != 0, which may be negative; `per_h` is 1 / h. Returns false and changes
  /// nothing if the rod would turn too far.
  bool advance(double h, double per_h) {
    const double kick = 0.5 * h, kicked = rate + kick * gain, sine = h * kicked;
    const double under_root = 1 - sine * sine;
    if (!(under_root > kMinCosineSquared)) return false;
    const double cosine = std::sqrt(under_root);
    const Vec2 next = cosine * direction + sine * perpendicular(direction);
    gain = cross(next, acceleration);
    rate = kicked + kick * gain;
    const double bend = (1 - cosine) * per_h;
    pull -= (bend + kick * dot(acceleration, direction)) * direction +
            (bend + kick * dot(acceleration, next)) * next;
    direction = next;
    return true;
  }
};

/// Moves two bodies on one rod over h > 0, and writes the joint's force. Returns false and changes nothing if
/// the method is impossible, for example if a body turns, or the rod is stretched or turns too far per stage.
bool stepRod(JointBody& a, JointBody& b, Joint& joint, double h, Vec2 gravity, const JointOptions& options,
             JointCounters& counters);

}  // namespace naiad::physics
