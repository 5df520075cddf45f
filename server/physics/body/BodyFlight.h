// The flight of a body within a tick, under all its forces.
#pragma once

#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"
#include "physics/flight/FlightSpring.h"
#include "physics/joint/Joint.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// Computes the flight from the row's state over `t` ticks, starting at `time`, under `acceleration` (gravity
/// and applied force). Freeze the body if the status is not kDone.
IntegratorStatus flyBody(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time,
                         double t, const IntegratorOptions& options, Flown& flown,
                         IntegratorCounters& counters);

/// A spring pull −k·(x − to) − c·v, in addition to a constant acceleration.
struct Pull {
  Place to;
  Spring spring;  ///< per unit of mass
  friend constexpr bool operator==(const Pull& a, const Pull& b) {
    return a.to == b.to && a.spring.stiffness == b.spring.stiffness && a.spring.damping == b.spring.damping;
  }
};

/// Approximates the forces on a body by a pull, for solvers that also apply contacts and so cannot call
/// flyBody(). Returns false if a constant force within the tick is accurate enough. Springs are returned
/// exactly. A field is linearised where it is stiff (more than 1 per tick²), by its Jacobian or by three
/// calls, with the stiffness of its steepest direction. `acceleration` is the part not in `pull`.
bool pullOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Pull& pull);

/// A magnet's effect on a body, for the solvers that use pullOf().
struct Magnet {
  double rate = 0;  ///< rate at which it turns the velocity: rad per tick, from x to y
  Vec2 rest;        ///< acceleration by all other forces
};

/// True if there is a magnet that turns the velocity and damps it little. Calls the field four times.
bool magnetOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Magnet& magnet);

/// Returns the joint for this pull: a kMouse without a force limit. The caller sets its `b`.
Joint jointOf(const Pull& pull, double mass);

/// Like flyBody(), for a body whose centre hangs on a spring joint (kSpring) from `anchor`, a point of the
/// world. Uses a formula if the body moves along the spring or its length is 0; integrates otherwise.
IntegratorStatus flyHanging(const BodyRow& row, const BodyMedium& medium, const Joint& spring, Place anchor,
                            Vec2 acceleration, double time, const IntegratorOptions& options, Flown& flown,
                            IntegratorCounters& counters);

}  // namespace naiad::physics
