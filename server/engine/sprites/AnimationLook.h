// An animation as watchers are told of it: the pictures of its sprite, and a clock that says whose turn it
// is. As long as nobody but the clock meddles, they draw it without being told anything more.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/sprites/Animation.h"
#include "shared/replica/Look.h"

namespace df {

/// What `animation` shows in `tick`, and will show after it unless it is stopped, set or hidden. Null if the
/// pictures cannot be told, or are no more than one. `before`, what this returned an earlier time, is
/// returned again if it still holds.
std::shared_ptr<const naiad::Look> lookOf(const Animation& animation, std::uint32_t tick,
                                          const std::shared_ptr<const naiad::Look>& before);

}  // namespace df
