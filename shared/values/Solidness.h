// The role of an Object in collisions (Dragonfly book, Listing 4.103).
#pragma once

namespace df {

/// Values are fixed: they travel on the wire.
enum Solidness {
  HARD,      ///< Object causes collisions and impedes.
  SOFT,      ///< Object causes collisions, but doesn't impede.
  SPECTRAL,  ///< Object doesn't cause collisions.
};

}  // namespace df
