// A rotation as a unit complex number: turning a vector costs four products and no transcendental function.
#pragma once

#include <cmath>

#include "Elementary.h"
#include "Vec2.h"

namespace naiad::physics {

struct Rotation {
  double cosine = 1;
  double sine = 0;

  friend constexpr Vec2 operator*(Rotation r, Vec2 a) {
    return {r.cosine * a.x - r.sine * a.y, r.sine * a.x + r.cosine * a.y};
  }
  friend constexpr Rotation operator*(Rotation a, Rotation b) {
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
  }
  friend constexpr bool operator==(Rotation a, Rotation b) = default;
};

constexpr Rotation inverse(Rotation r) {
  return {r.cosine, -r.sine};
}

/// By `angle` radians, from x to y. Small angles take a series without a call (error below 1e-17).
inline Rotation rotationBy(double angle) {
  if (std::abs(angle) < 0.25) {
    const double z = angle * angle;
    const double sine =
        1 - z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72 * (1 - z / 110 * (1 - z / 156)))));
    const double cosine =
        1 - z / 2 * (1 - z / 12 * (1 - z / 30 * (1 - z / 56 * (1 - z / 90 * (1 - z / 132)))));
    return {cosine, angle * sine};
  }
  const df::math::SineCosine both = df::math::sincos(angle);
  return {both.cosine, both.sine};
}

/// The angle in [−π, π].
inline double angleOf(Rotation r) {
  return df::math::atan2(r.sine, r.cosine);
}

/// Takes out what rounding has added to the length.
inline Rotation normalized(Rotation r) {
  const double scale = 1 / std::sqrt(r.cosine * r.cosine + r.sine * r.sine);
  return {r.cosine * scale, r.sine * scale};
}

}  // namespace naiad::physics
