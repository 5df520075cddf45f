// One move and one obstacle, by the rules of docs/collisions.md worked out anew: what swept moves are judged
// by. It shares no function with the engine, only its number type.
//
// A move visits representable positions: at time t in [0,1] of a way w each coordinate has gone ⌊|w|·t⌋ units
// towards its end. On one axis two boxes touch from one step of the way to another; divided by the way's
// length these are the times between which they do, and the first touch is the later of the two axes'
// beginnings, if it comes before both ends. All of it is exact.
#pragma once

#include <cstdint>
#include <optional>

#include "shared/values/Fixed.h"

namespace bench {

/// A time in a move. Denominator 0: never ends.
struct Fraction {
  std::int64_t over = 0;
  std::int64_t under = 1;

  double value() const { return static_cast<double>(over) / static_cast<double>(under); }
  friend bool operator<(Fraction a, Fraction b) {
    __extension__ using Wide = __int128;
    return static_cast<Wide>(a.over) * b.under < static_cast<Wide>(b.over) * a.under;
  }
};

/// The steps of one axis on which two boxes touch, the first and the last one; `way` steps are all.
struct Steps {
  std::int64_t first;
  std::int64_t last;
  std::int64_t way;

  Fraction begin() const { return {first, way == 0 ? 1 : way}; }
  Fraction end() const { return way == 0 ? Fraction{1, 0} : Fraction{last + 1, way}; }  // not in it
};

/// Do the two boxes touch, edges included?
bool areTouching(const df::FixedBox& a, const df::FixedBox& b);

/// A box on its way, which is less than 2^30 cells long.
class Path {
 public:
  /// The box in world coordinates where it starts.
  Path(const df::FixedBox& box, df::FixedVector way) : m_box(box), m_way(way) {}

  const df::FixedBox& start() const { return m_box; }
  df::FixedVector way() const { return m_way; }
  /// When it first touches the obstacle; nothing if it does not. Not for one that it touches at the start:
  /// there is another rule for those.
  std::optional<Fraction> firstTouch(const df::FixedBox& obstacle) const;
  /// The steps on which the horizontal (vertical) extents touch; nothing if they never do.
  std::optional<Steps> stepsX(const df::FixedBox& obstacle) const;
  std::optional<Steps> stepsY(const df::FixedBox& obstacle) const;
  /// How far it has gone at this time, and at the last position before it.
  df::FixedVector goneAt(Fraction time) const;
  df::FixedVector goneBefore(Fraction time) const;

 private:
  df::FixedBox m_box;
  df::FixedVector m_way;
};

}  // namespace bench
