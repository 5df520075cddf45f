// A 2×2 matrix, for Jacobians and effective masses.
#pragma once

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

struct Mat22 {
  double xx = 0, xy = 0;  ///< first row
  double yx = 0, yy = 0;  ///< second row

  friend constexpr Vec2 operator*(const Mat22& m, Vec2 v) {
    return {m.xx * v.x + m.xy * v.y, m.yx * v.x + m.yy * v.y};
  }
  friend constexpr Mat22 operator*(const Mat22& a, const Mat22& b) {
    return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
            a.yx * b.xy + a.yy * b.yy};
  }
  friend constexpr Mat22 operator+(const Mat22& a, const Mat22& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
  }
  friend constexpr bool operator==(const Mat22& a, const Mat22& b) = default;
};

inline constexpr Mat22 kIdentity = {1, 0, 0, 1};

constexpr double determinant(const Mat22& m) {
  return m.xx * m.yy - m.xy * m.yx;
}

/// Returns x with m·x = b; zero if m is singular.
constexpr Vec2 solve(const Mat22& m, Vec2 b) {
  const double d = determinant(m);
  if (d == 0) return {};
  return {(b.x * m.yy - m.xy * b.y) / d, (m.xx * b.y - b.x * m.yx) / d};
}

}  // namespace naiad::physics
