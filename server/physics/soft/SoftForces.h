// Deformations of a soft body's springs and the directions of their forces, used by its step and its energy.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/soft/SoftBody.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

struct SoftSpan {
  double length;   ///< > 0
  Vec2 direction;  ///< unit length, from a to b
};

/// Returns length and direction of a spring. The length is at least a millionth of the rest length.
inline SoftSpan spanOf(const SoftBody& body, const SoftStretch& s) {
  const Vec2 offset =
      body.nodes[static_cast<std::size_t>(s.b)].offset - body.nodes[static_cast<std::size_t>(s.a)].offset;
  const double far = length(offset), least = 1e-6 * s.rest_length;
  return far > least ? SoftSpan{far, offset / far} : SoftSpan{least, {1, 0}};
}

/// Returns the part of the stretch that is beyond the limit; `longer` is the stretch beyond the rest length.
inline double tautBeyond(const SoftStretch& s, double longer) {
  return s.limit > 0 ? std::max(0.0, longer - s.limit * s.rest_length) : 0;
}

struct SoftCorner {
  double bent;     ///< present angle minus rest angle, −π … π
  Vec2 slopes[3];  ///< derivatives of the angle with respect to the offsets of c, b and a
};

inline SoftCorner cornerOf(const SoftBody& body, const SoftBend& s) {
  constexpr double kPi = 3.14159265358979323846;
  const Vec2 b = body.nodes[static_cast<std::size_t>(s.b)].offset;
  const Vec2 first = s.a < 0 ? s.direction : b - body.nodes[static_cast<std::size_t>(s.a)].offset;
  const Vec2 second = body.nodes[static_cast<std::size_t>(s.c)].offset - b;
  const double squares[] = {lengthSquared(first), lengthSquared(second)};
  SoftCorner corner = {0, {{}, {}, {}}};
  if (!(squares[0] > 1e-24 && squares[1] > 1e-24)) return corner;  // no corner: it has no angle
  const double angle = df::math::atan2(cross(first, second), dot(first, second)) - s.rest_angle;
  corner.bent = angle > kPi ? angle - 2 * kPi : angle < -kPi ? angle + 2 * kPi : angle;
  const Vec2 before = s.a < 0 ? Vec2{} : perpendicular(first) / squares[0];
  const Vec2 after = perpendicular(second) / squares[1];
  corner.slopes[0] = after;
  corner.slopes[1] = -(after + before);
  corner.slopes[2] = before;
  return corner;
}

/// Returns the area inside the boundary; negative if the boundary is ordered from y to x.
inline double areaOf(const SoftBody& body) {
  double twice = 0;
  const Vec2 from = body.nodes[static_cast<std::size_t>(body.boundary[0])].offset;
  for (std::size_t i = 1; i + 1 < body.boundary.size(); ++i) {
    twice += cross(body.nodes[static_cast<std::size_t>(body.boundary[i])].offset - from,
                   body.nodes[static_cast<std::size_t>(body.boundary[i + 1])].offset - from);
  }
  return 0.5 * twice;
}

inline double pressureOf(const SoftBody& body) {
  return body.pressure + body.bulk * (1 - areaOf(body) / body.rest_area);
}

}  // namespace naiad::physics
