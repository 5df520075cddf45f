// The flags of an Object in its world's store.
#pragma once

#include <cstdint>

namespace df {

struct ObjectFlags {
  /// An engine that is built without the options beyond the book has their setters, but nothing of what they
  /// do.
#if defined(NAIAD_WITHOUT_LAYERS)
  static constexpr bool kLayers = false;
#else
  static constexpr bool kLayers = true;
#endif
  enum Flag : std::uint32_t {
    kInWorld = 1 << 0,
    kActive = 1 << 1,
    kVisible = 1 << 2,
    kNoSoft = 1 << 3,
    kHeap = 1 << 4,      ///< made with `new`: the world's to delete
    kMarked = 1 << 5,    ///< to be deleted after update
    kLookKept = 1 << 6,  ///< its static look was drawn, and is repeated
    kDirty = 1 << 7,     ///< in the list of changes
    kReported = 1 << 8,  ///< the host has its state
    kDerive = 1 << 9,    ///< speed and direction follow from the velocity
    kStaticLook = 1 << 10,
    kNeverDraws = 1 << 11,  ///< its dynamic type is Object itself
    kTyped = 1 << 12,       ///< kNeverDraws and kDeaf have been found out
    kFollowed = 1 << 13,    ///< a view follows it
    kDeaf = 1 << 14,        ///< its class does not override eventHandler()
    kSwept = 1 << 15,
    kPrecise = 1 << 16,
    kRestContacts = 1 << 17,
    kMayMoveOut = 1 << 18,
    kBody = 1 << 19,     ///< moved by a layer, not by the book's rules
    kPainted = 1 << 24,  ///< has a sprite or a shape, which draw() shows unless its class overrides it
    kOnView = 1 << 25,   ///< a view object: drawn at every position
    kFrames = 1 << 28,   ///< it has frames
  };
};

}  // namespace df
