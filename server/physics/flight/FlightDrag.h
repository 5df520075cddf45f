// Flight with quadratic drag. (FlightSpring.h handles linear drag, as a spring without stiffness.)
#pragma once

#include "physics/flight/FlightFree.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// Solves v' = a − q·|v|·v along a line in closed form by tanh, tan or 1/(1 + qvt). `drag` is q >= 0, per
/// cell; the terminal velocity is √(a/q).
struct FlownOnLine {
  double displacement;
  double velocity;
};
FlownOnLine flyQuadraticDragOnLine(double velocity, double acceleration, double drag, double t);

/// Computes a flight in the plane. Uses the closed form for motion along a line (acceleration or velocity
/// zero, or both parallel). Other motions have no closed form and are integrated with error control to about
/// 1e-12 of displacement and velocity (1e-9 if drag is so strong that the implicit method is used). Adds the
/// integration's work to `counters`. If the status is not kDone, `flown` is where it stopped.
IntegratorStatus flyQuadraticDrag(Vec2 velocity, Vec2 acceleration, double drag, double t, Flown& flown,
                                  IntegratorCounters& counters);

}  // namespace naiad::physics
