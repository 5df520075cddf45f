// Flight on a damped spring with rest length zero, fixed at a point.
//
// Solves x″ = a − k·x − c·x′, where x is relative to the fixed point, by the exponential of its 2×2 matrix in
// each of its three cases, so the stiffness does not limit the step. Error per step: a few units in the last
// place of the amplitude and of the phase ω·t (which is calculated with 106 bits). Without stiffness the
// motion is that of linear drag, exact for every c >= 0 and t >= 0.
#pragma once

#include "physics/flight/FlightFree.h"

namespace naiad::physics {

/// A spring, with its constants divided by the mass.
struct Spring {
  double stiffness = 0;  ///< k: force over length and mass, per unit of time squared; >= 0
  double damping = 0;    ///< c: force over velocity and mass, per unit of time; >= 0; includes linear drag
};

/// The motion on a spring over a time t >= 0. Construction costs about two transcendental functions, a call a
/// few nanoseconds. Bodies on equal springs can share the object.
class SpringFlow {
 public:
  SpringFlow(Spring spring, double t);

  /// Returns the motion. `offset` is from the fixed point to the body; `acceleration` is by all other forces.
  Flown operator()(Vec2 offset, Vec2 velocity, Vec2 acceleration) const {
    const Vec2 pull = acceleration - m_stiffness * offset;
    return {m_integral_response * pull + m_displacement_response * velocity,
            m_displacement_response * pull + m_velocity_response * velocity};
  }

 private:
  void series(double damping, double t);
  void overdamped(double damping, double t);
  void underdamped(double damping, double t);

  double m_stiffness;
  // The response at t to a unit velocity at 0: velocity, displacement, and integral of the displacement.
  double m_velocity_response;
  double m_displacement_response;
  double m_integral_response;
};

inline Flown flySpring(Vec2 offset, Vec2 velocity, Vec2 acceleration, Spring spring, double t) {
  return SpringFlow(spring, t)(offset, velocity, acceleration);
}

}  // namespace naiad::physics
