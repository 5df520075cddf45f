// Between the world's cells and the metric in which bodies live.
//
// A character cell is about twice as high as wide. Bodies live where a unit is the width of a cell both ways:
// x is the same, y is multiplied by the aspect. Boxes of the book stay boxes in cells.
#pragma once

#include <cmath>

#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"
#include "shared/values/Fixed.h"
#include "shared/values/Vector.h"

namespace naiad::physics {

class Metric {
 public:
  static constexpr double kMinAspect = 0.25;  ///< height over width of a character cell
  static constexpr double kMaxAspect = 4;

  /// `aspect`: height of a cell over its width, kMinAspect … kMaxAspect. Where it is a whole number, or a
  /// half or a quarter, conversions are exact, and a scene that is moved by whole cells goes on as it did.
  explicit Metric(double aspect = 2)
      : m_aspect(aspect), m_per_aspect(isPowerOfTwo(aspect) ? 1 / aspect : 0) {}
  double aspect() const { return m_aspect; }

  /// A displacement, a velocity, a force …
  Vec2 fromCells(df::Vector v) const { return {v.x(), v.y() * m_aspect}; }
  df::Vector toCells(Vec2 v) const { return {v.x, overAspect(v.y)}; }

  Place placeOf(df::FixedVector position) const;
  /// Rounded to nearest. `place` lies within df::kMaxCells: see isInRange().
  df::FixedVector fixedOf(const Place& place) const;
  /// Can fixedOf() express it?
  bool isInRange(const Place& place) const;
  /// A position in cells, all its digits.
  Place placeAtCells(df::Vector position) const;
  df::Vector cellsOf(const Place& place) const;

 private:
  static bool isPowerOfTwo(double x) {
    int exponent = 0;
    return std::frexp(x, &exponent) == 0.5;
  }
  // The same quotient either way; a product is ready much sooner.
  double overAspect(double y) const { return m_per_aspect != 0 ? y * m_per_aspect : y / m_aspect; }

  double m_aspect;
  double m_per_aspect;  // exact; 0 if that is not to be had
};

}  // namespace naiad::physics
