// A hash of a world's state, to compare a world replayed from its inputs with the original.
#pragma once

#include <cstdint>

namespace df {

class World;

/// Hashes all that decides the future of the world, as far as the engine has it (Objects with their types,
/// motions and boxes, and players), and what the last tick drew, in which a game's own members show. Pointers
/// and memory addresses do not count. Call it between two ticks; it walks over all Objects.
std::uint64_t hashState(const World& world);

}  // namespace df
