// A hash of a world's state, by which a world that is executed again from its inputs is held against the
// first.
#pragma once

#include <cstdint>

namespace df {

class World;

/// Of all that decides how the world goes on, as far as the engine has it (Objects with their types, motions
/// and boxes, and players), and of what the last tick drew, in which members of a game's own show. No pointer
/// and no memory address counts. Between two ticks; costs a walk over all Objects.
std::uint64_t hashState(const World& world);

}  // namespace df
