// Where a body is: a whole number of metric cells and the rest.
//
// The physics never sees an absolute coordinate in floating point, only differences of places and
// displacements, so a scene that is moved by whole cells, to 1e9 of them, behaves the same to the last bit.
#pragma once

#include <cmath>
#include <cstdint>

#include "physics/geometry/Vec2.h"
#include "shared/math/DoubleDouble.h"

namespace naiad::physics {

/// Metric: a unit is the width of a character both ways, so y is scaled by the aspect of a cell. The rest
/// lies in [−0.5, 0.5), so that equal places are equal; a whole part stays below 2^62, which is the caller's
/// to see to.
struct Place {
  std::int64_t cell_x = 0;
  std::int64_t cell_y = 0;
  double dx = 0;
  double dy = 0;

  friend constexpr bool operator==(const Place& a, const Place& b) = default;
};

/// The displacement from b to a. Exact whenever the difference has no more digits than a double.
constexpr Vec2 operator-(const Place& a, const Place& b) {
  return {static_cast<double>(a.cell_x - b.cell_x) + (a.dx - b.dx),
          static_cast<double>(a.cell_y - b.cell_y) + (a.dy - b.dy)};
}

namespace place_detail {

constexpr void advance(std::int64_t& cell, double& rest, double by) {
  const double whole = df::math::rounded(by);
  const double sum = rest + (by - whole);  // `by − whole` is exact
  const double carried = df::math::rounded(sum);
  cell += static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(carried);
  rest = sum - carried;
  if (rest < 0.5) return;
  rest -= 1;
  ++cell;
}

}  // namespace place_detail

/// `from` moved by `by`, with one rounding per axis, of the rest. Each component of `by` is below 2^51 cells.
constexpr Place operator+(Place from, Vec2 by) {
  place_detail::advance(from.cell_x, from.dx, by.x);
  place_detail::advance(from.cell_y, from.dy, by.y);
  return from;
}

/// The place of a point near the origin, |x|, |y| < 2^51.
constexpr Place placeAt(Vec2 point) {
  return Place{} + point;
}

}  // namespace naiad::physics
