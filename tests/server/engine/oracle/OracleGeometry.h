// The geometry of docs/collisions.md in its plainest form: the gap between two boxes, and the times at which
// a box on a straight path hits another. Of the engine it uses only the number type.
#pragma once

#include <cstdint>
#include <optional>

#include "OracleMask.h"
#include "shared/values/Fixed.h"

namespace oracle {

using df::Fixed;
using df::FixedBox;
using df::FixedVector;

/// Large enough for the distance of any two positions and for products of distances.
__extension__ typedef __int128 Wide;

/// A time of a move, from 0 to 1, as an unrounded fraction. 2/1 means never.
struct Time {
  std::uint64_t numerator = 0;
  std::uint64_t denominator = 1;

  friend bool operator<(Time a, Time b);
  double toDouble() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// A move's straight path. At time t each coordinate has covered the whole units of t times its distance.
struct SweepPath {
  FixedVector from;
  FixedVector to;

  FixedVector at(Time time) const;
  /// Returns the last position before `time`; `from` for time 0.
  FixedVector before(Time time) const;
};

/// True if the two boxes, in world coordinates, overlap or touch (Listing 4.107, for boxes).
inline bool boxIntersectsBox(const FixedBox& a, const FixedBox& b) {
  const bool x_apart = (b.corner.x > a.corner.x + a.size.x) | (a.corner.x > b.corner.x + b.size.x);
  const bool y_apart = (b.corner.y > a.corner.y + a.size.y) | (a.corner.y > b.corner.y + b.size.y);
  return !(x_apart | y_apart);  // one branch is faster than four, and the oracle spends most of its time here
}

/// Returns the distance of two boxes on the axis where it is larger; negative if they overlap.
Wide gap(const FixedBox& a, const FixedBox& b);

/// True if the gap from `box` (relative to the position) to `other` (in world coordinates) shrinks as soon as
/// the move begins: the move must approach on every side where the distance equals the gap.
bool closesGap(const FixedBox& box, const SweepPath& path, const FixedBox& other);

/// Returns when `box` (relative to the path's position) hits `other` (in world coordinates), by the boxes.
std::optional<Time> firstTouch(const SweepPath& path, const FixedBox& box, const FixedBox& other);

/// Like firstTouch(), by boxes and masks.
std::optional<Time> firstShare(const SweepPath& path, const FixedBox& box, const Mask& mask,
                               const FixedBox& other, const Mask& others_mask);

}  // namespace oracle
