// A hash of a world's state, to compare a world replayed from its inputs with the original.
#pragma once

#include <cstdint>

namespace df {

class World;

/// Returns a hash of the engine's state that decides the future of the world (the number of ticks, game over,
/// Objects with their types, motions and boxes, and players), and of the characters that the last tick drew,
/// because these depend on a game's own members. Excludes memory addresses and the random sequence. Call it
/// between two ticks; it visits all Objects.
std::uint64_t hashState(const World& world);

}  // namespace df
