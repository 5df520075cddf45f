#include "physics/flight/FlightElastic.h"

namespace naiad::physics {

namespace {

Mat22 outer(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}

Mat22 scaled(const Mat22& m, double s) {
  return {m.xx * s, m.xy * s, m.yx * s, m.yy * s};
}

}  // namespace

bool ElasticField::jacobian(Vec2 position, Vec2 velocity, double /*time*/, Mat22& by_position,
                            Mat22& by_velocity) const {
  const double distance = length(position);
  if (distance == 0) {
    by_position = by_velocity = {};
    return true;
  }
  const Vec2 outward = position / distance;
  const Mat22 along = outer(outward, outward);
  const Mat22 across = kIdentity + scaled(along, -1);
  const double radial = dot(velocity, outward);
  const double pull = m_stiffness * (distance - m_rest_length) + m_damping * radial;
  // The pull changes along the spring by the stiffness and, as the spring turns, by the velocity across; its
  // direction turns with the position.
  const Vec2 turning = (velocity - radial * outward) / distance;
  by_position = scaled(along, -m_stiffness) + scaled(outer(outward, turning), -m_damping) +
                scaled(across, -pull / distance);
  by_velocity = scaled(along, -m_damping);
  return true;
}

}  // namespace naiad::physics
