// Where a body flies in a tick, by whatever moves it.
#pragma once

#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"
#include "physics/joint/Joint.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// From the row's state, over `t` ticks from `time` on, under `acceleration` (gravity and forces). A status
/// other than kDone: the body is to be frozen.
IntegratorStatus flyBody(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time,
                         double t, const IntegratorOptions& options, Flown& flown,
                         IntegratorCounters& counters);

/// The same on a spring joint (kSpring) from `anchor`, a point of the world, to its middle. By formula while
/// it moves along the spring, or if that has length 0; integrated otherwise.
IntegratorStatus flyHanging(const BodyRow& row, const BodyMedium& medium, const Joint& spring, Place anchor,
                            Vec2 acceleration, double time, const IntegratorOptions& options, Flown& flown,
                            IntegratorCounters& counters);

}  // namespace naiad::physics
