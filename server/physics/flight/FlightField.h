// Flight through a force field that a game defines.
#pragma once

#include "physics/flight/FlightFree.h"
#include "physics/geometry/Mat22.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// The acceleration by a field. Must be a pure function of its arguments and of data that is constant during
/// a tick: it is called several times per tick, in any order, and for states that the body never reaches.
class ForceField {
 public:
  virtual ~ForceField() = default;
  /// `position` is relative to the field's origin, in metric cells; `time` is that of the world.
  virtual Vec2 acceleration(Vec2 position, Vec2 velocity, double time) const = 0;
  /// Computes the acceleration's derivatives. If it returns false, integrators use finite differences.
  virtual bool jacobian(Vec2 /*position*/, Vec2 /*velocity*/, double /*time*/, Mat22& /*by_position*/,
                        Mat22& /*by_velocity*/) const {
    return false;
  }
};

/// The part of an acceleration that is proportional to the velocity, λv as complex numbers, and the rest.
struct Turning {
  Vec2 lambda;  ///< (−damping, rate of turning in rad per tick)
  Vec2 rest;
};

/// Computes the linear part at this state. Calls the field four times.
Turning turningAt(const ForceField& field, Vec2 position, Vec2 velocity, double time);

/// Flies from `time` to `time + t` by the method of `options`. `position` is relative to the field's origin.
/// The automatic method first tries closed forms, for fields that turn the velocity fast, or that pull hard
/// in proportion to the distance. If the status is not kDone, `flown` is where it stopped, and the caller
/// should freeze the body.
IntegratorStatus flyField(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t,
                          const IntegratorOptions& options, Flown& flown, IntegratorCounters& counters);

}  // namespace naiad::physics
