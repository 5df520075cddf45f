// An animation as clients get it: the pictures of its sprite, and a clock that says which of them shows.
// While only the clock decides, clients draw it without further messages.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/sprites/Animation.h"
#include "shared/replica/Look.h"

namespace df {

/// What `animation` shows in `tick`, and will show after it unless it is stopped, set or hidden. Null if the
/// pictures cannot be described, or are no more than one. `before`, what this returned an earlier time, is
/// returned again if it still holds.
std::shared_ptr<const naiad::Look> lookOf(const Animation& animation, std::uint32_t tick,
                                          const std::shared_ptr<const naiad::Look>& before);

class SpritePictures {
 public:
  /// All frames of a sprite. Empty if they cannot be described: there are none, too many (kMaxFrames) or too
  /// large ones, or only such as draw nothing.
  static const naiad::Sequence& of(const Sprite& sprite) { return sprite.pictures(); }
};

}  // namespace df
