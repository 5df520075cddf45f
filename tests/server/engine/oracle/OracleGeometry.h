// The geometry of docs/collisions.md, each sentence in its plainest form: the gap of two boxes, and the times
// at which a box on a straight path hits another. Nothing of the engine is used here but its number type.
#pragma once

#include <cstdint>
#include <optional>

#include "OracleMask.h"
#include "shared/values/Fixed.h"

namespace oracle {

using df::Fixed;
using df::FixedBox;
using df::FixedVector;

/// Room for the distance of any two positions, and for their products.
__extension__ typedef __int128 Wide;

/// A time in [0,1] of a move: a fraction, never rounded. (2/1 is never.)
struct Time {
  std::uint64_t numerator = 0;
  std::uint64_t denominator = 1;

  friend bool operator<(Time a, Time b);
  double toDouble() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// A move's straight path. At time t each coordinate has gone the whole units of its distance times t.
struct SweepPath {
  FixedVector from;
  FixedVector to;

  FixedVector at(Time time) const;
  /// The last position before `time`; `from` for time 0.
  FixedVector before(Time time) const;
};

/// Do the two boxes, in world coordinates, overlap or touch? (Listing 4.107, for boxes.)
inline bool boxIntersectsBox(const FixedBox& a, const FixedBox& b) {
  const bool x_apart = (b.corner.x > a.corner.x + a.size.x) | (a.corner.x > b.corner.x + b.size.x);
  const bool y_apart = (b.corner.y > a.corner.y + a.size.y) | (a.corner.y > b.corner.y + b.size.y);
  return !(x_apart | y_apart);  // this is most of what the oracle does: one branch is faster than four
}

/// The distance of two boxes on the axis on which it is larger; negative if they overlap.
Wide gap(const FixedBox& a, const FixedBox& b);

/// Does the gap from `box`, relative to the position, to `other`, in world coordinates, shrink as soon as the
/// move begins? It does if the move brings each side closer on which the boxes are as far apart as the gap.
bool closesGap(const FixedBox& box, const SweepPath& path, const FixedBox& other);

/// When does `box`, relative to the position on its path, hit `other`, in world coordinates, by the boxes?
std::optional<Time> firstTouch(const SweepPath& path, const FixedBox& box, const FixedBox& other);

/// When do they hit by boxes and masks?
std::optional<Time> firstShare(const SweepPath& path, const FixedBox& box, const Mask& mask,
                               const FixedBox& other, const Mask& others_mask);

}  // namespace oracle
