// Fixed-point world coordinates: the only number type of the world store, the replica and the wire.
//
// A coordinate is an int64 in units of 2^-32 cell. Sums are exact and associative, so a path does not depend
// on its place in the world, the compiler or the optimisation level, and server and client get equal sums.
//
// Ranges: a position is within ±kMaxCells on each axis (2e9 cells; the type itself reaches 2^31), a velocity
// or acceleration within ±kMaxVelocityCells per tick. A valid position plus a valid velocity never overflows.
#pragma once

#include <cmath>
#include <cstdint>
#if __cplusplus >= 201703L
#include <optional>
#endif

#include "detail/LanguageStandard.h"

namespace df {

/// A coordinate or a length in units of 2^-32 cell.
using Fixed = std::int64_t;

inline constexpr int kFixedBits = 32;
inline constexpr Fixed kFixedOne = Fixed{1} << kFixedBits;
/// Largest magnitude of a position coordinate, in cells.
inline constexpr double kMaxCells = 2e9;
/// Largest magnitude of a velocity or acceleration component, in cells per tick (2^24).
inline constexpr double kMaxVelocityCells = 16777216.0;

/// A pair of coordinates. Plain data; arithmetic is exact within the ranges above.
struct FixedVector {
  Fixed x = 0;
  Fixed y = 0;

  friend constexpr bool operator==(FixedVector a, FixedVector b) { return a.x == b.x && a.y == b.y; }
  friend constexpr bool operator!=(FixedVector a, FixedVector b) { return !(a == b); }
};

/// An axis-aligned box in fixed point: upper left corner, and size >= 0.
struct FixedBox {
  FixedVector corner;
  FixedVector size;

  friend constexpr bool operator==(const FixedBox& a, const FixedBox& b) {
    return a.corner == b.corner && a.size == b.size;
  }
  friend constexpr bool operator!=(const FixedBox& a, const FixedBox& b) { return !(a == b); }
};

/// Converts fixed point to cells. Exact up to 2^21 cells; beyond that rounded to the nearest double.
constexpr double toCells(Fixed value) {
  return static_cast<double>(value) / static_cast<double>(kFixedOne);
}

/// Converts a whole number of cells.
constexpr Fixed fromCells(std::int32_t cells) {
  return static_cast<Fixed>(cells) * kFixedOne;
}

#if __cplusplus >= 201703L  // games, which may be C++11, do not need the rest

constexpr FixedVector operator+(FixedVector a, FixedVector b) {
  return {a.x + b.x, a.y + b.y};
}
constexpr FixedVector operator-(FixedVector a, FixedVector b) {
  return {a.x - b.x, a.y - b.y};
}

/// Returns `box` moved by `offset`.
constexpr FixedBox translate(FixedBox box, FixedVector offset) {
  return {box.corner + offset, box.size};
}

/// True if two closed boxes share a point: touching edges count (Dragonfly's positionsIntersect, |dx| <= 1).
constexpr bool intersects(const FixedBox& a, const FixedBox& b) {
  return a.corner.x <= b.corner.x + b.size.x && b.corner.x <= a.corner.x + a.size.x &&
         a.corner.y <= b.corner.y + b.size.y && b.corner.y <= a.corner.y + a.size.y;
}

/// Converts cells to fixed point, rounded to nearest (ties to even). Returns nullopt if `cells` is not finite
/// or exceeds `limit` in magnitude.
inline std::optional<Fixed> toFixed(double cells, double limit = kMaxCells) {
  if (!(cells >= -limit && cells <= limit)) return std::nullopt;  // also catches NaN
  return static_cast<Fixed>(std::llrint(cells * static_cast<double>(kFixedOne)));
}

/// Returns the character cell in which a coordinate is drawn: floor(v + 0.5), everywhere (server, client,
/// mouse). Adds as unsigned, so that a number from a hostile peer wraps instead of overflowing.
constexpr std::int32_t cellOf(Fixed value) {
  const auto shifted = static_cast<std::uint64_t>(value) + static_cast<std::uint64_t>(kFixedOne / 2);
  return static_cast<std::int32_t>(static_cast<Fixed>(shifted) >> kFixedBits);
}

#endif

}  // namespace df
