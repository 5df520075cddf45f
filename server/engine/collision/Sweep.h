// The geometry of one move along a straight line (docs/collisions.md, "Swept"): computes exactly when it
// first touches a box.
//
// At time t in [0,1] of a move by d, each coordinate has gone floor(|d|·t) units: the move visits only
// representable positions, and the sweep is the end-point test at every one of them. So the first time at
// which two boxes touch is a whole number of units over |d|. Moments are fractions, compared without
// rounding.
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
  /// Describes the move of an Object with `box`, relative to its position, from one legal position to
  /// another; they may be as far apart as the world is wide.
  Sweep(const FixedBox& box, FixedVector from, FixedVector to);

  /// Returns when the move hits `other` (world coordinates) by the boxes: the first time at which they touch.
  /// A pair that touches at the start counts, at time 0, only if the move closes the gap or they touch at the
  /// end.
  std::optional<Moment> firstTouch(const FixedBox& other) const {
    return mayTouch(other) ? touchOnPath(other) : std::nullopt;
  }
  /// Returns when it hits `other` by the boxes and the masks: the first time at which they touch and share a
  /// cell. The start counts as in firstTouch(); a pair that shares a cell at the start and does not count may
  /// hit again after the two have come apart. Null for a full mask.
  std::optional<Moment> firstShare(const Mask* p_own, const FixedBox& other, const Mask* p_others) const;

  /// Returns the last position before `moment`; the start for time 0. Never beyond the target.
  FixedVector before(Moment moment) const;
  /// True if the gap to `other` shrinks as soon as the move begins.
  bool closesGap(const FixedBox& other) const;
  /// True if the boxes touch at the start and the gap is larger at the end.
  bool movesOutOf(const FixedBox& other) const;

 private:
  struct Gap;

  // The steps of an axis at which its coordinate lies within a range: from `enter` on, before `leave`. An
  // axis that does not move has length 0: then `enter` is 0, and `leave` over 0 is never.
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
