// Shots at targets of all kinds: who flies, what it looks like, how fast and from where.
#pragma once

#include "Range.h"
#include "shared/values/SplitMix64.h"

namespace bench {

enum class Shape {
  UNIT,    ///< 1×1
  SPRITE,  ///< 3×2 to 12×4, all of it set
  GLYPHS,  ///< the same sizes, characters with holes, precise
  THIN,    ///< 0.01×8 or 8×0.01
  NEEDLE,  ///< 0.01×0.01
  WALL,    ///< 10,000×1 or 1×10,000
};

enum class Motion {
  REST,     ///< the younger one flies at the older one, which is at rest
  FIRES,    ///< the older one flies, the younger one is at rest
  BOTH,     ///< both fly, in any direction
  HEAD_ON,  ///< both fly along an axis, towards each other, hardly aside
};

/// A pair of kinds: the older one takes the first turn.
struct Pairing {
  const char* name;
  Shape older;
  Shape younger;
  Motion motion = Motion::REST;
  Make make_older{};
  Make make_younger{};
  int ticks = 1;     ///< of a shot, which then begins so far away
  double speed = 0;  ///< cells per tick, if not at random
};

/// Draw a shot: set the two up so that they are at a contact at some moment - of the first turn, of the
/// second, or of a flight in which both fly at the same time - and do not touch at the start.
void aim(const Pairing& pairing, Flier& older, Flier& younger, naiad::SplitMix64& random);

}  // namespace bench
