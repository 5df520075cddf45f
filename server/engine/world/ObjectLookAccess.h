// Sets frames of an Object, for the engine's own kinds of Objects such as bodies. Games use sprites
// (setSprite), so neither this header nor the types of its parameters are installed.
#pragma once

#include "shared/replica/Look.h"

namespace df {

class Object;

class ObjectLookAccess {
 public:
  /// Sets pictures of the Object. In each tick, draw() shows the picture that `selector` selects for
  /// WorldView::tick: an animation, or a rotation in steps. While only the tick decides which picture is
  /// shown, nothing is sent to clients. An empty sequence removes the frames. Returns 0, or -1 without change
  /// if the selector does not fit or the pictures are too many or too large (kMaxFrames, kMaxGlyphs,
  /// kMaxGlyphOffset, kMaxLookBytes).
  static int setFrames(Object& object, const naiad::Sequence& frames, const naiad::Selector& selector);
  /// Replaces the selector. Returns 0, or -1 if it does not fit or there are no frames.
  static int setSelector(Object& object, const naiad::Selector& selector);
};

}  // namespace df
