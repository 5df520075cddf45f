// The bodies of an ImpactWorld: axis-aligned boxes and circles that do not rotate.
#pragma once

#include <cmath>
#include <cstdint>

#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"

namespace naiad::physics {

enum class ImpactShape : std::uint8_t { kBox, kCircle };

/// A body. Time is in ticks, lengths are in metric cells.
struct ImpactBody {
  Place place;              ///< place of the centre
  Vec2 velocity;            ///< metric cells per tick
  Vec2 acceleration;        ///< gravity plus force over mass, constant within a tick
  Vec2 half = {0.5, 0.5};   ///< half size of the box, not 0 in both axes, or the radius in x; >= 0
  double inverse_mass = 1;  ///< 0: static or, if it has a velocity, kinematic; other bodies do not push it
  double restitution = 0;   ///< 0 … 1; a pair has the larger of its two
  double friction = 0;      ///< >= 0; a pair has the geometric mean of its two
  ImpactShape shape = ImpactShape::kBox;

  friend constexpr bool operator==(const ImpactBody& a, const ImpactBody& b) = default;
};

/// True if all numbers are in the ranges above and at most 1e30, sizes 1e12, the place's `dx` and `dy` 1.
inline bool isValid(const ImpactBody& body) {
  constexpr double kLargest = 1e30;  // squares and products of two stay finite
  const auto isSmall = [](double x) { return std::fabs(x) <= kLargest; };  // false for NaN
  const bool has_size = body.shape == ImpactShape::kCircle
                            ? body.half.x > 0
                            : body.half.x >= 0 && body.half.y >= 0 && body.half.x + body.half.y > 0;
  return has_size && body.half.x <= 1e12 && body.half.y <= 1e12 && isSmall(body.velocity.x) &&
         isSmall(body.velocity.y) && isSmall(body.acceleration.x) && isSmall(body.acceleration.y) &&
         body.inverse_mass >= 0 && isSmall(body.inverse_mass) && body.restitution >= 0 &&
         body.restitution <= 1 && body.friction >= 0 && isSmall(body.friction) &&
         std::fabs(body.place.dx) <= 1 && std::fabs(body.place.dy) <= 1;
}

/// Returns half of the size of the body's bounding box.
constexpr Vec2 halfExtentOf(const ImpactBody& body) {
  return body.shape == ImpactShape::kCircle ? Vec2{body.half.x, body.half.x} : body.half;
}

constexpr double restitutionOf(const ImpactBody& a, const ImpactBody& b) {
  return a.restitution > b.restitution ? a.restitution : b.restitution;
}
inline double frictionOf(const ImpactBody& a, const ImpactBody& b) {
  return std::sqrt(a.friction * b.friction);
}

}  // namespace naiad::physics
