// The geometry of one move along a straight line (docs/collisions.md, "Swept"): computes exactly when it
// first touches a box.
//
// At time t in [0,1] of a move by d, each coordinate has moved by floor(|d|·t) units. So the move visits only
// representable positions, and the sweep gives the same result as the end-point test at every one of them.
// The first time at which two boxes touch is a whole number of units divided by |d|. Moments are fractions,
// which are compared without rounding.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>

#include "shared/values/Fixed.h"

namespace df {

class Mask;

/// A time in [0,1] of a move, as a fraction of it. The denominator is not zero.
struct Moment {
  std::uint64_t numerator = 0;
  std::uint64_t denominator = 1;

  friend std::strong_ordering operator<=>(Moment a, Moment b);
  friend bool operator==(Moment a, Moment b) { return std::is_eq(a <=> b); }
  double toDouble() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

class Sweep {
 public:
  /// Describes the move of an Object with `box`, relative to its position, from one valid position to
  /// another, at any distance.
  Sweep(const FixedBox& box, FixedVector from, FixedVector to);

  /// Returns when the mover's box hits `other` (in world coordinates): the first time at which they touch. If
  /// they touch at the start, it is a hit at time 0 only if the move closes the gap or they touch at the end.
  std::optional<Moment> firstTouch(const FixedBox& other) const {
    return mayTouch(other) ? touchOnPath(other) : std::nullopt;
  }
  /// Returns when the mover hits `other` if masks are compared too: the first time at which the boxes touch
  /// and the masks share a cell. The start counts as in firstTouch(). A pair that shares a cell at the start
  /// without a hit may hit after the two have separated. A null mask is a full one.
  std::optional<Moment> firstShare(const Mask* p_own, const FixedBox& other, const Mask* p_others) const;

  /// Returns the last position before `moment`; the start for time 0. Never beyond the target.
  FixedVector before(Moment moment) const;
  /// True if the gap to `other` shrinks as soon as the move begins.
  bool closesGap(const FixedBox& other) const;
  /// True if the boxes touch at the start and the gap is larger at the end.
  bool movesOutOf(const FixedBox& other) const;

 private:
  struct Gap;

  // The steps of an axis at which its coordinate lies within a range: from `enter` to before `leave`. For an
  // axis that does not move, `enter` is 0, and it never leaves, because `leave` is divided by its length, 0.
  struct Stay {
    std::uint64_t enter;
    std::uint64_t leave;
  };

  // One axis of the move: `length` steps of one unit each.
  struct Axis {
    Fixed low;  // low edge of the box at the start
    Fixed size;
    std::uint64_t length;  // |d|
    int direction;         // sign of d
    Fixed path_low;        // range that the box covers from the start to the end
    Fixed path_high;

    bool reaches(Fixed first, Fixed last) const;
    Stay stayWithin(Fixed first, Fixed last) const;
    Fixed lowAfter(std::uint64_t steps) const;
    std::uint64_t stepsBy(Moment moment) const;
    std::uint64_t stepsBefore(Moment moment) const;
    std::uint64_t stepsToCell(std::int64_t cell) const;
    Gap gapTo(Fixed low_then, Fixed other_low, Fixed other_size) const;
  };

  // One branch for all four sides, because most boxes near a path are not on it.
  bool mayTouch(const FixedBox& other) const {
    const bool is_beside = (other.corner.x > m_x.path_high) | (other.corner.x + other.size.x < m_x.path_low);
    const bool is_above = (other.corner.y > m_y.path_high) | (other.corner.y + other.size.y < m_y.path_low);
    return !(is_beside | is_above);
  }
  std::optional<Moment> touchOnPath(const FixedBox& other) const;
  std::optional<Moment> bothWithin(const Stay& x, const Stay& y) const;
  bool endsWithin(const Stay& x, const Stay& y) const { return m_x.length < x.leave && m_y.length < y.leave; }

  Axis m_x;
  Axis m_y;
  FixedVector m_from;
};

}  // namespace df
