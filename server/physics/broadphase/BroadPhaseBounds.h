// Bounds of a body in whole numbers, as the broad phase compares them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Place.h"

namespace naiad::physics {

/// Bounds in units of 1/64 metric cell, both ends included, up to 2^55 cells. In whole numbers, the bounds of
/// a scene that is moved by whole cells are exactly the moved bounds.
struct GridBounds {
  std::int64_t lower_x, lower_y, upper_x, upper_y;

  friend constexpr bool operator==(const GridBounds& a, const GridBounds& b) = default;
};

inline constexpr std::int64_t kGridUnits = 64;  ///< number of units in a metric cell
/// Bounds are limited to this many units (2^46 cells) around the body's place, to avoid overflow.
inline constexpr double kMaxGridUnits = 0x1p52;

constexpr bool overlap(const GridBounds& a, const GridBounds& b) {
  return a.lower_x <= b.upper_x && b.lower_x <= a.upper_x && a.lower_y <= b.upper_y && b.lower_y <= a.upper_y;
}
constexpr bool contains(const GridBounds& outer, const GridBounds& inner) {
  return outer.lower_x <= inner.lower_x && outer.lower_y <= inner.lower_y && inner.upper_x <= outer.upper_x &&
         inner.upper_y <= outer.upper_y;
}
constexpr GridBounds unite(const GridBounds& a, const GridBounds& b) {
  return {std::min(a.lower_x, b.lower_x), std::min(a.lower_y, b.lower_y), std::max(a.upper_x, b.upper_x),
          std::max(a.upper_y, b.upper_y)};
}

/// Returns the smallest grid bounds around `bounds` at `place`, enlarged by `margin` >= 0 metric cells on
/// every side. Accepts any numbers, because a body that was hit very hard has bounds before it is frozen.
inline GridBounds gridBounds(const Place& place, const Bounds& bounds, double margin) {
  const auto whole = [](double units) {
    const double bound = units < kMaxGridUnits ? units : kMaxGridUnits;  // the limit also replaces NaN
    return static_cast<std::int64_t>(bound > -kMaxGridUnits ? bound : -kMaxGridUnits);
  };
  const auto down = [&whole](double x) { return whole(std::floor(x * kGridUnits)); };
  const auto up = [&whole](double x) { return whole(std::ceil(x * kGridUnits)); };
  const std::int64_t x = place.cell_x * kGridUnits, y = place.cell_y * kGridUnits;
  return {x + down(place.dx + bounds.lower.x - margin), y + down(place.dy + bounds.lower.y - margin),
          x + up(place.dx + bounds.upper.x + margin), y + up(place.dy + bounds.upper.y + margin)};
}

}  // namespace naiad::physics
