// Sends contact events of bodies to Objects.
#pragma once

#include <vector>

#include "physics/body/BodyState.h"

namespace naiad::physics {

/// Sorts `contacts` by (time, ids). Sends an EventCollision to both Objects of each contact that began, and
/// an EventContactEnd to the bodies that asked for it if a contact ended. Handlers may delete any Object. An
/// Object that did not get the event of the begin, because a handler removed one of the two before, gets no
/// end. Returns true if this happened; then `missed` is set.
bool sendContactEvents(World& world, std::vector<BodyContact>& contacts);

}  // namespace naiad::physics
