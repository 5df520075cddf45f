// The constraints of an island and their Jacobians.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/joint/JointIsland.h"

namespace naiad::physics {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// The sine of the angle, made monotone beyond a right angle.
double bentSine(Rotation r) {
  if (r.c >= 0) return r.s;
  return r.s >= 0 ? 2 - r.s : -2 - r.s;
}

}  // namespace

void JointIsland::setArms() {
  for (Link& link : m_links) {
    if (link.is_plain) continue;
    if (link.a >= 0) link.arm_a = m_rotation[at(link.a)] * link.anchor_a;
    link.arm_b = m_rotation[at(link.b)] * link.anchor_b;
  }
}

void JointIsland::setRow(int row, const Link& link, Vec2 n, double ja, double jb) {
  m_rows[at(row)] = {n, ja, jb, link.a, link.b};
}

template <bool kJacobian>
void JointIsland::evaluateAngle(const Link& link, int row) {
  if (row < 0) return;
  const Rotation between = inverse(m_rotation[at(link.a)]) * m_rotation[at(link.b)];
  m_value[at(row)] = bentSine(inverse(m_joints[link.index].reference) * between);
  if constexpr (kJacobian) setRow(row, link, {}, -1, 1);
}

template <bool kJacobian>
void JointIsland::evaluateLimit(Link& link) {
  const int row = link.row[0];
  const Joint& joint = m_joints[link.index];
  const Rotation between = inverse(m_rotation[at(link.a)]) * m_rotation[at(link.b)];
  const double angle = angleOf(inverse(joint.reference) * between);
  if constexpr (kJacobian) {
    setRow(row, link, {}, -1, 1);
    const bool is_lower = angle - joint.lower < joint.upper - angle;
    const double low = is_lower ? 0 : -kNoLimit, high = is_lower ? kNoLimit : 0;
    if (low != m_low[at(row)] || high != m_high[at(row)]) m_side[at(row)] = is_lower ? -1 : 1;
    m_low[at(row)] = low;
    m_high[at(row)] = high;
    link.bound = is_lower ? joint.lower : joint.upper;
  }
  m_value[at(row)] = angle - link.bound;
}

template <bool kJacobian>
void JointIsland::evaluate() {
  if (!kJacobian && !m_rods.empty()) {
    double* value = m_value.data();
    for (const Rod& rod : m_rods) {
      const Vec2 way = m_place[at(rod.b)] - m_place[at(rod.a)];
      *value++ = (lengthSquared(way) - rod.square) * rod.half_inverse_length;
    }
    return;
  }
  for (Link& link : m_links) {
    const int row = link.row[0];
    Vec2 way = m_place[at(link.b)] + link.arm_b;
    way -= link.a >= 0 ? m_place[at(link.a)] + link.arm_a : link.target;
    switch (link.kind) {
      case JointKind::kDistance:
      case JointKind::kRope:  // (d² − L²) / 2L needs no root, and is as good as d − L where it is 0
        m_value[at(row)] = (lengthSquared(way) - link.length * link.length) * link.half_inverse_length;
        if constexpr (kJacobian) {
          const Vec2 n = (2 * link.half_inverse_length) * way;
          setRow(row, link, n, -cross(link.arm_a, n), cross(link.arm_b, n));
        }
        break;
      case JointKind::kSpring:
        if (link.length > 0) {
          const double distance = physics::length(way);
          m_value[at(row)] = distance - link.length;
          if constexpr (kJacobian) {
            const Vec2 n = distance > 0 ? way / distance : Vec2{1, 0};
            setRow(row, link, n, -cross(link.arm_a, n), cross(link.arm_b, n));
          }
          break;
        }
        [[fallthrough]];
      case JointKind::kHinge:
      case JointKind::kWeld:
      case JointKind::kMouse:
        m_value[at(row)] = way.x;
        m_value[at(link.row[1])] = way.y;
        if constexpr (kJacobian) {
          setRow(row, link, {1, 0}, link.arm_a.y, -link.arm_b.y);
          setRow(link.row[1], link, {0, 1}, -link.arm_a.x, link.arm_b.x);
        }
        if (link.kind == JointKind::kWeld) evaluateAngle<kJacobian>(link, link.row[2]);
        break;
      case JointKind::kSlider: {
        const Vec2 n = perpendicular(m_rotation[at(link.a)] * m_joints[link.index].axis);
        m_value[at(row)] = dot(n, way);
        if constexpr (kJacobian) setRow(row, link, n, -cross(link.arm_a + way, n), cross(link.arm_b, n));
        evaluateAngle<kJacobian>(link, link.row[1]);
        break;
      }
      case JointKind::kMotor:
        m_value[at(row)] = 0;
        if constexpr (kJacobian) setRow(row, link, {}, -1, 1);
        break;
      case JointKind::kAngleLimit:
        evaluateLimit<kJacobian>(link);
        break;
    }
  }
}

template void JointIsland::evaluate<true>();
template void JointIsland::evaluate<false>();

// What h asks of soft rows and of those with a greatest force. A soft row's impulse s is the same in both
// halves of a stage, −h·k·(C + C′)/4 − c·(C′ − C)/2: the trapezoidal rule. Where h does not resolve the
// oscillation, backward Euler damps it instead of letting it ring.
void JointIsland::prepareRows(double h) {
  for (const int row : m_soft) {
    const Joint& joint = m_joints[m_links[at(m_link_of[at(row)])].index];
    const JointRow& r = m_rows[at(row)];
    double answer = m_mass[at(r.b)].inverse_mass + m_mass[at(r.b)].inverse_inertia * r.jb * r.jb;
    if (r.a >= 0) answer += m_mass[at(r.a)].inverse_mass + m_mass[at(r.a)].inverse_inertia * r.ja * r.ja;
    const bool is_resolved = h < 0 || h * h * joint.stiffness * answer <= 4;
    const double now = is_resolved ? 0.25 * h * joint.stiffness : 0;
    const double push = (is_resolved ? 0.25 : 0.5) * h * joint.stiffness + 0.5 * joint.damping;
    m_value_before[at(row)] = m_value[at(row)];
    const bool is_idle = !(std::abs(push) > 1e-280);
    m_softness[at(row)] = is_idle ? 0 : 1 / push;
    m_memory[at(row)] = is_idle ? 0 : (now - 0.5 * joint.damping) / push;
    m_diagonal[at(row)] = is_idle ? 0 : 1 / (push * h);
    m_is_out[at(row)] = is_idle || m_side[at(row)] != 0 ? 1 : 0;
    if (is_idle) m_multiplier[at(row)] = 0;
  }
  for (const int row : m_one_sided) {
    if (m_kind[at(row)] == Kind::kSoft || m_kind[at(row)] == Kind::kMotor) {
      const double most = 0.5 * std::abs(h) * m_joints[m_links[at(m_link_of[at(row)])].index].max_force;
      m_low[at(row)] = -most;
      m_high[at(row)] = most;
    }
    if (m_side[at(row)] != 0) m_multiplier[at(row)] = m_side[at(row)] < 0 ? m_low[at(row)] : m_high[at(row)];
    if (m_kind[at(row)] != Kind::kSoft) m_is_out[at(row)] = m_side[at(row)] != 0 ? 1 : 0;
  }
}

double JointIsland::speedAlong(const JointRow& row) const {
  double speed = dot(row.n, m_velocity[at(row.b)]) + row.jb * m_spin[at(row.b)];
  if (row.a >= 0) speed += row.ja * m_spin[at(row.a)] - dot(row.n, m_velocity[at(row.a)]);
  return speed;
}

double JointIsland::targetSpeed(int row) const {
  return m_kind[at(row)] == Kind::kMotor ? m_joints[m_links[at(m_link_of[at(row)])].index].speed : 0;
}

double JointIsland::residual(int row, double h) const {
  switch (m_kind[at(row)]) {
    case Kind::kSoft:
      return m_value[at(row)] + m_memory[at(row)] * m_value_before[at(row)] +
             m_softness[at(row)] * m_multiplier[at(row)];
    case Kind::kMotor:
      return h * (speedAlong(m_rows[at(row)]) - targetSpeed(row));
    default:
      return m_value[at(row)];
  }
}

}  // namespace naiad::physics
