// Tells Objects of the contacts of bodies.
#pragma once

#include <vector>

#include "engine/world/World.h"
#include "physics/body/BodyPlan.h"

namespace df {

/// Sorts `contacts` by (time, ids) and tells both of each: an EventCollision when it began, and when it ended
/// an EventContactEnd to those bodies that asked for it. Handlers may do anything; who is gone, hears
/// nothing.
void tellContacts(World& world, std::vector<naiad::physics::BodyContact>& contacts);

}  // namespace df
