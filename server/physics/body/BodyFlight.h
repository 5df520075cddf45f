// Where a body flies in a tick, by whatever moves it.
#pragma once

#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"
#include "physics/flight/FlightSpring.h"
#include "physics/joint/Joint.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// From the row's state, over `t` ticks from `time` on, under `acceleration` (gravity and forces). A status
/// other than kDone: the body is to be frozen.
IntegratorStatus flyBody(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time,
                         double t, const IntegratorOptions& options, Flown& flown,
                         IntegratorCounters& counters);

/// What pulls a body the more, the farther it is away: −k·(x − to) − c·v, beside a constant acceleration.
struct Pull {
  Place to;
  Spring spring;  ///< per unit of mass
  friend constexpr bool operator==(const Pull& a, const Pull& b) {
    return a.to == b.to && a.spring.stiffness == b.spring.stiffness && a.spring.damping == b.spring.damping;
  }
};

/// For solvers that hold the body against other things, and therefore cannot fly it: is it pulled so that a
/// force that is constant within a tick would not do? A spring is taken as it is; a field is linearised where
/// it is stiff (more than 1 per tick²), by its Jacobian or three calls of it, with the stiffness of its
/// steepest direction. What `pull` leaves out is `acceleration`.
bool pullOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Pull& pull);

/// Likewise, what a magnet does to it.
struct Magnet {
  double rate = 0;  ///< at which it turns the body's velocity: rad per tick, from x to y
  Vec2 rest;        ///< the acceleration by everything else
};

/// Is there one, which turns more than it damps? Four calls of the field.
bool magnetOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Magnet& magnet);

/// The joint that pulls a body so: a kMouse without a limit, whose b is still to be set.
Joint jointOf(const Pull& pull, double mass);

/// The same as flyBody() on a spring joint (kSpring) from `anchor`, a point of the world, to its middle. By
/// formula while it moves along the spring, or if that has length 0; integrated otherwise.
IntegratorStatus flyHanging(const BodyRow& row, const BodyMedium& medium, const Joint& spring, Place anchor,
                            Vec2 acceleration, double time, const IntegratorOptions& options, Flown& flown,
                            IntegratorCounters& counters);

}  // namespace naiad::physics
