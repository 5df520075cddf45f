// A force field of a spring with a rest length, attached to a fixed point. The motion in the plane has no
// closed form.
#pragma once

#include "physics/flight/FlightField.h"

namespace naiad::physics {

inline Mat22 outer(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}

inline Mat22 scaled(const Mat22& m, double s) {
  return {m.xx * s, m.xy * s, m.yx * s, m.yy * s};
}

/// Pulls towards the field's origin from beyond `rest_length`, pushes away from within it, and damps motion
/// along the spring. Undefined at the origin.
class ElasticField final : public ForceField {
 public:
  /// `push` is an additional constant acceleration, such as gravity.
  ElasticField(double stiffness, double damping, double rest_length, Vec2 push)
      : m_stiffness(stiffness), m_damping(damping), m_rest_length(rest_length), m_push(push) {}

  Vec2 acceleration(Vec2 position, Vec2 velocity, double /*time*/) const override {
    const double distance = length(position);
    const Vec2 outward = position / distance;
    const double pull = m_stiffness * (distance - m_rest_length) + m_damping * dot(velocity, outward);
    return m_push - pull * outward;
  }

  bool jacobian(Vec2 position, Vec2 velocity, double time, Mat22& by_position,
                Mat22& by_velocity) const override;

 private:
  double m_stiffness;    // force over length and mass, per unit of time squared
  double m_damping;      // force over velocity and mass, per unit of time
  double m_rest_length;  // metric cells
  Vec2 m_push;
};

inline bool ElasticField::jacobian(Vec2 position, Vec2 velocity, double /*time*/, Mat22& by_position,
                                   Mat22& by_velocity) const {
  const double distance = length(position);
  const Vec2 outward = position / distance;
  const Mat22 along = outer(outward, outward);
  const Mat22 across = kIdentity + scaled(along, -1);
  const double radial = dot(velocity, outward);
  const double pull = m_stiffness * (distance - m_rest_length) + m_damping * radial;
  // Along the spring, the pull changes by the stiffness and, because the spring turns, by the velocity across
  // the spring. The pull's direction turns with the position.
  const Vec2 turning = (velocity - radial * outward) / distance;
  by_position = scaled(along, -m_stiffness) + scaled(outer(outward, turning), -m_damping) +
                scaled(across, -pull / distance);
  by_velocity = scaled(along, -m_damping);
  return true;
}

}  // namespace naiad::physics
