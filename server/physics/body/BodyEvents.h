// Sends Objects the events of the contacts of bodies.
#pragma once

#include <vector>

#include "physics/body/BodyState.h"

namespace naiad::physics {

/// Sorts `contacts` by (time, ids) and sends both Objects of each an EventCollision when it began, and when
/// it ended an EventContactEnd to those bodies that asked for it. Handlers may do anything; an Object that is
/// gone gets no event.
void sendContactEvents(World& world, std::vector<BodyContact>& contacts);

}  // namespace naiad::physics
