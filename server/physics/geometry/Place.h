// A body's position: a whole number of metric cells plus a remainder.
//
// The physics never uses absolute floating-point coordinates, only differences of places and displacements.
// So a scene that is moved by whole cells, up to 1e9, behaves identically to the last bit.
#pragma once

#include <cmath>
#include <cstdint>

#include "physics/geometry/Vec2.h"
#include "shared/math/DoubleDouble.h"

namespace naiad::physics {

/// The unit is the width of a character along both axes, so y is scaled by the aspect of a cell. The
/// remainder lies in [−0.5, 0.5), so that equal places compare equal. The caller must ensure that the whole
/// part stays below 2^62.
struct Place {
  std::int64_t cell_x = 0;
  std::int64_t cell_y = 0;
  double dx = 0;
  double dy = 0;

  friend constexpr bool operator==(const Place& a, const Place& b) = default;
};

/// Returns the displacement from b to a. Exact if the difference fits the digits of a double.
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

/// Returns `from` moved by `by`, rounding the remainder once per axis. `by` is below 2^51 cells per axis.
constexpr Place operator+(Place from, Vec2 by) {
  place_detail::advance(from.cell_x, from.dx, by.x);
  place_detail::advance(from.cell_y, from.dy, by.y);
  return from;
}

/// Returns the place of a point near the origin, |x|, |y| < 2^51.
constexpr Place placeAt(Vec2 point) {
  return Place{} + point;
}

}  // namespace naiad::physics
