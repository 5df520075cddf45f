// Flight through a medium whose drag grows with the square of the velocity. (One whose drag grows with the
// velocity is a spring without stiffness: FlightSpring.h.)
#pragma once

#include "physics/flight/FlightFree.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

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
