// Integrators of fixed step for x″ = a(x, x′, t): the classics, cheap and without error control.
#pragma once

#include "physics/flight/FlightField.h"

namespace naiad::physics {

/// Position and velocity of a body in a field, at a time.
struct FieldState {
  Vec2 position;
  Vec2 velocity;
  double time = 0;
};

/// `options.substeps` steps of options.method over `t`. Semi-implicit Euler, velocity Verlet, Yoshida's of
/// order 4 (H. Yoshida, "Construction of higher order symplectic integrators", 1990), Runge and Kutta's of
/// order 4. Verlet sees forces that depend on the velocity through a predicted one: still of order 2, but no
/// longer symplectic; Yoshida's is then of order 2, too.
void integrateFixed(const ForceField& field, FieldState& state, double t, const IntegratorOptions& options,
                    IntegratorCounters& counters);

}  // namespace naiad::physics
