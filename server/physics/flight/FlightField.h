// Flight through a field of force that a game defines.
#pragma once

#include "physics/flight/FlightFree.h"
#include "physics/geometry/Mat22.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// What a field does to a body, per unit of mass. Must be a pure function of its arguments (and of what does
/// not change during a tick): it is called several times per tick, in an order of the integrator's choosing,
/// and with states that the body never reaches.
class ForceField {
 public:
  virtual ~ForceField() = default;
  /// `position` is relative to the field's own origin, in metric cells; `time` is the world's.
  virtual Vec2 acceleration(Vec2 position, Vec2 velocity, double time) const = 0;
  /// The acceleration's derivatives. Optional: with false, integrators that need them take differences.
  virtual bool jacobian(Vec2 /*position*/, Vec2 /*velocity*/, double /*time*/, Mat22& /*by_position*/,
                        Mat22& /*by_velocity*/) const {
    return false;
  }
};

/// How the velocity alone changes itself: a(v) − a(0) = λv, as complex numbers, and what differs from that.
struct Turning {
  Vec2 lambda;  ///< − damping, rate of turning in rad per tick
  Vec2 rest;
};

/// Four calls of the field.
Turning turningAt(const ForceField& field, Vec2 position, Vec2 velocity, double time);

/// From `time` to `time + t`, by the method of `options`. `position` is relative to the field's origin.
/// A status other than kDone: `flown` is where it stopped, and the caller should freeze the body.
IntegratorStatus flyField(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t,
                          const IntegratorOptions& options, Flown& flown, IntegratorCounters& counters);

}  // namespace naiad::physics
