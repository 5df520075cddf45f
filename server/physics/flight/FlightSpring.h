// Flight on a damped spring of rest length zero to a point.
//
// x″ = a − k·x − c·x′, x from the spring's fixed point: solved by the exponential of its 2×2 matrix in each
// of its three cases, so the stiffness sets no limit to the step. Error per step: a few units in the last
// place of the amplitude, and of the phase ω·t (which is carried with 106 bits). Without stiffness it is
// linear drag alone, exact for every c >= 0 and t >= 0.
#pragma once

#include "physics/flight/FlightFree.h"

namespace naiad::physics {

/// A spring as the body feels it, per unit of mass.
struct Spring {
  double stiffness = 0;  ///< k: force over length and mass, per unit of time squared; >= 0
  double damping = 0;    ///< c: force over velocity and mass, per unit of time; >= 0. Linear drag adds to it.
};

/// The flow over a time t >= 0. Making one costs two transcendental functions or so; using it, a few
/// nanoseconds. Bodies on equal springs share it.
class SpringFlow {
 public:
  SpringFlow(Spring spring, double t);

  /// `offset` is from the spring's fixed point to the body, `acceleration` what else pushes it.
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
  // The response at t to a unit velocity at 0: velocity, displacement, and the integral of that.
  double m_velocity_response;
  double m_displacement_response;
  double m_integral_response;
};

inline Flown flySpring(Vec2 offset, Vec2 velocity, Vec2 acceleration, Spring spring, double t) {
  return SpringFlow(spring, t)(offset, velocity, acceleration);
}

}  // namespace naiad::physics
