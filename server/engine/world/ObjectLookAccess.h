// Frames of an Object, for the engine's own kinds of Objects: bodies set them. Games use sprites (setSprite),
// so neither this header nor the types of its parameters are installed.
#pragma once

#include "shared/replica/Look.h"

namespace df {

class Object;

class ObjectLookAccess {
 public:
  /// Pictures of the Object, of which draw() shows the one that `selector` names for the tick (WorldView's):
  /// an animation, or a turn in steps. While only the tick decides which frame shows, nothing is sent to
  /// clients. An empty sequence removes the frames. Return 0, or -1 (and no change) if the selector does not
  /// fit, or if the pictures are too large to be described (kMaxGlyphs, kMaxLookBytes).
  static int setFrames(Object& object, const naiad::Sequence& frames, const naiad::Selector& selector);
  /// Replace the selector. Return 0, or -1 if it does not fit or there are no frames.
  static int setSelector(Object& object, const naiad::Selector& selector);
};

}  // namespace df
