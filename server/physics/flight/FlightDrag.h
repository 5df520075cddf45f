// Flight through a medium: drag that grows with the velocity (linear) or with its square (quadratic).
#pragma once

#include "physics/flight/FlightFree.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// The flow of v' = a − c·v over a time t: exact for every c >= 0 and t >= 0, from no drag at all to one that
/// stops the body at once. Making one costs an exponential; using it, a few nanoseconds. Bodies with the same
/// drag share it.
class LinearDragFlow {
 public:
  /// `drag` is c: force over velocity and mass, per unit of time.
  LinearDragFlow(double drag, double t);

  Flown operator()(Vec2 velocity, Vec2 acceleration) const {
    return {m_displacement_response * velocity + m_integral_response * acceleration,
            m_velocity_response * velocity + m_displacement_response * acceleration};
  }

 private:
  double m_velocity_response;      // e^−ct
  double m_displacement_response;  // its integral
  double m_integral_response;      // the integral of that
};

inline Flown flyLinearDrag(Vec2 velocity, Vec2 acceleration, double drag, double t) {
  return LinearDragFlow(drag, t)(velocity, acceleration);
}

/// v' = a − q·|v|·v along one line, in closed form: tanh, tan, or 1/(1 + qvt), whichever fits. `drag` is q >=
/// 0, per cell; its limit velocity is √(a/q).
struct FlownOnLine {
  double displacement;
  double velocity;
};
FlownOnLine flyQuadraticDragOnLine(double velocity, double acceleration, double drag, double t);

/// The same in the plane. Along one line (no acceleration, no velocity, or both parallel) the closed form;
/// otherwise, for there is none, error-controlled integration to about 1e-12 of displacement and velocity
/// (1e-9 where drag is so strong that the implicit method takes over). `counters` adds up what the
/// integration took. A status other than kDone: `flown` is where it stopped.
IntegratorStatus flyQuadraticDrag(Vec2 velocity, Vec2 acceleration, double drag, double t, Flown& flown,
                                  IntegratorCounters& counters);

}  // namespace naiad::physics
