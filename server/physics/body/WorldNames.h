// Makes names of the engine that bodies use known in the namespace of the physics.
#pragma once

#include "engine/world/WorldView.h"
#include "shared/values/Fixed.h"
#include "shared/values/Solidness.h"
#include "shared/values/Vector.h"

namespace df {
class Object;
class World;
class WorldStore;
}  // namespace df

namespace naiad::physics {

using df::Fixed;
using df::FixedBox;
using df::FixedVector;
using df::HARD;
using df::kMaxVelocityCells;
using df::Object;
using df::ObjectKey;
using df::SOFT;
using df::Vector;
using df::World;
using df::WorldStore;

}  // namespace naiad::physics
