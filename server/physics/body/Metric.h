// Converts between the world's cells and the metric in which bodies move.
//
// A character cell is about twice as high as wide. The metric's unit is the width of a cell along both axes:
// x is unchanged, y is multiplied by the aspect. The boxes of Objects are in cells.
#pragma once

#include <cmath>

#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"
#include "shared/values/Fixed.h"
#include "shared/values/Vector.h"

namespace naiad::physics {

class Metric {
 public:
  static constexpr double kMinAspect = 0.25;  ///< limit of the height over width of a character cell
  static constexpr double kMaxAspect = 4;

  /// `aspect` is the height of a cell over its width, kMinAspect … kMaxAspect. If it is a whole number, a
  /// half or a quarter, conversions are exact, and a scene moved by whole cells behaves identically.
  explicit Metric(double aspect = 2)
      : m_aspect(aspect), m_per_aspect(isPowerOfTwo(aspect) ? 1 / aspect : 0) {}
  double aspect() const { return m_aspect; }

  /// Converts a displacement, velocity or force.
  Vec2 fromCells(df::Vector v) const { return {v.x(), v.y() * m_aspect}; }
  df::Vector toCells(Vec2 v) const { return {v.x, overAspect(v.y)}; }

  Place placeOf(df::FixedVector position) const;
  /// Converts a place to a position, rounded to nearest. `place` must be in range (isInRange()).
  df::FixedVector fixedOf(const Place& place) const;
  /// True if fixedOf() can represent the place.
  bool isInRange(const Place& place) const;
  /// Converts a position in cells with full precision.
  Place placeAtCells(df::Vector position) const;
  df::Vector cellsOf(const Place& place) const;

 private:
  static bool isPowerOfTwo(double x) {
    int exponent = 0;
    return std::frexp(x, &exponent) == 0.5;
  }
  // Both formulas give equal quotients; the multiplication is much faster.
  double overAspect(double y) const { return m_per_aspect != 0 ? y * m_per_aspect : y / m_aspect; }

  double m_aspect;
  double m_per_aspect;  // 1 / aspect, if that is exact; else 0
};

}  // namespace naiad::physics
