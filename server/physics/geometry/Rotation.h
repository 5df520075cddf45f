// A rotation as a complex number of length one.
//
// Quarter turns are exact, so shapes along the axes have no rounding errors. A rotation by a small angle, as
// in a step, needs no elementary function.
#pragma once

#include "Elementary.h"
#include "Vec2.h"

namespace naiad::physics {

/// y grows downward: a positive angle turns from x to y, which is clockwise on the screen.
struct Rotation {
  double c = 1;  ///< cosine
  double s = 0;  ///< sine

  friend constexpr Vec2 operator*(Rotation q, Vec2 v) {
    return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y};
  }
  /// Returns the rotation by b, then by a; the order does not matter in the plane.
  friend constexpr Rotation operator*(Rotation a, Rotation b) {
    return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
  }
  friend constexpr bool operator==(Rotation a, Rotation b) = default;
};

constexpr Rotation inverse(Rotation q) {
  return {q.c, -q.s};
}

/// Returns `q` with its length reset to one after rounding: an error e becomes 3/2 e². Needs no square root.
constexpr Rotation renormalised(Rotation q) {
  const double factor = 1.5 - 0.5 * (q.c * q.c + q.s * q.s);
  return {q.c * factor, q.s * factor};
}

/// Returns the rotation by `angle`, in radians and finite.
inline Rotation rotationBy(double angle) {
  const df::math::SineCosine of = df::math::sincos(angle);
  return {of.cosine, of.sine};
}

/// Returns the angle in radians in [−π, π].
inline double angleOf(Rotation q) {
  return df::math::atan2(q.s, q.c);
}

/// Returns `q` rotated by a finite angle; only rounding makes errors. Up to 1/8 rad it uses the diagonal Padé
/// approximation of order 8, whose length is one by construction and whose error is below 3e-16; for larger
/// angles it uses the elementary functions.
inline Rotation turned(Rotation q, double angle) {
  if (angle == 0) return q;
  if (!(angle > -0.125 && angle < 0.125)) return renormalised(q * rotationBy(angle));
  const double square = angle * angle;
  const Vec2 half = {1 - square * (3.0 / 28 - square / 1680), angle * (0.5 - square / 84)};
  const double by = 1 / lengthSquared(half);
  const Rotation turn = {(half.x - half.y) * (half.x + half.y) * by, 2 * half.x * half.y * by};
  return renormalised(q * turn);
}

}  // namespace naiad::physics
