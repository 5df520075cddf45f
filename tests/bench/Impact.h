// One move and one obstacle by the rules of docs/collisions.md: an independent reference for swept moves.
// This code shares only the number type with the engine.
//
// A move visits representable positions: at time t in [0,1] of a way w each coordinate has gone ⌊|w|·t⌋ units
// towards its end. On one axis, two boxes touch from a first to a last step of the way. Divided by the way's
// length, these steps are the times between which they touch. The first contact is the later one of the two
// axes' beginnings, if it is before both ends. All of this is exact.
#pragma once

#include <cstdint>
#include <optional>

#include "shared/values/Fixed.h"

namespace bench {

/// A time in a move. Denominator 0 means never.
struct Fraction {
  std::int64_t over = 0;
  std::int64_t under = 1;

  double value() const { return static_cast<double>(over) / static_cast<double>(under); }
  friend bool operator<(Fraction a, Fraction b) {
    __extension__ using Wide = __int128;
    return static_cast<Wide>(a.over) * b.under < static_cast<Wide>(b.over) * a.under;
  }
};

/// First and last step of an axis on which two boxes touch. `way` is the number of all steps.
struct Steps {
  std::int64_t first;
  std::int64_t last;
  std::int64_t way;

  Fraction begin() const { return {first, way == 0 ? 1 : way}; }
  Fraction end() const { return way == 0 ? Fraction{1, 0} : Fraction{last + 1, way}; }  // after the contact
};

/// True if the two boxes touch, edges included.
bool areTouching(const df::FixedBox& a, const df::FixedBox& b);

/// A box that moves a distance of less than 2^30 cells.
class Path {
 public:
  /// `box` is in world coordinates at the start.
  Path(const df::FixedBox& box, df::FixedVector way) : m_box(box), m_way(way) {}

  const df::FixedBox& start() const { return m_box; }
  df::FixedVector way() const { return m_way; }
  /// Returns when the box first touches the obstacle; nullopt if never, or if it touches it at the start, for
  /// which there is another rule.
  std::optional<Fraction> firstTouch(const df::FixedBox& obstacle) const;
  /// Returns the steps on which the horizontal (vertical) extents touch; nullopt if never.
  std::optional<Steps> stepsX(const df::FixedBox& obstacle) const;
  std::optional<Steps> stepsY(const df::FixedBox& obstacle) const;
  /// Return how far the box has moved at this time, and at the last position before this time.
  df::FixedVector goneAt(Fraction time) const;
  df::FixedVector goneBefore(Fraction time) const;

 private:
  df::FixedBox m_box;
  df::FixedVector m_way;
};

}  // namespace bench
