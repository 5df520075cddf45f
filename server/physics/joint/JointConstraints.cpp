#include "physics/joint/JointConstraints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/joint/JointRows.h"

namespace naiad::physics {

void JointConstraints::load(const JointMotion& motion, std::span<const Joint> all_joints) {
  joints = all_joints.data();
  for (Link& link : links) {
    const Joint& joint = all_joints[at(link.index)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (link.row[k] >= 0) multiplier[at(link.row[k])] = joint.memory[k];
    }
    if (joint.kind == JointKind::kMouse) link.target = joint.target - motion.origin;
  }
  std::fill(force.begin(), force.end(), Vec2{});
  std::fill(torque.begin(), torque.end(), 0.0);
  setArms(motion);
  evaluate<true>(motion);
}

void JointConstraints::store(std::span<Joint> all_joints, double h, double last_h) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    Joint& joint = all_joints[at(links[i].index)];
    joint.force = force[i] / h;
    joint.torque = torque[i] / h;
    for (std::size_t k = 0; k < 3; ++k) {
      if (links[i].row[k] >= 0) joint.memory[k] = multiplier[at(links[i].row[k])] / last_h;
    }
  }
}

const Joint& JointConstraints::jointOf(int at_row) const {
  return joints[links[at(link_of[at(at_row)])].index];
}

void JointConstraints::setArms(const JointMotion& motion) {
  for (Link& link : links) {
    if (link.is_plain) continue;
    if (link.a >= 0) link.arm_a = motion.rotation[at(link.a)] * link.anchor_a;
    link.arm_b = motion.rotation[at(link.b)] * link.anchor_b;
  }
}

void JointConstraints::setRow(int at_row, const Link& link, Vec2 n, double ja, double jb) {
  rows[at(at_row)] = {n, ja, jb, link.a, link.b};
}

template <bool kJacobian>
void JointConstraints::evaluateAngle(const JointMotion& motion, const Link& link, int at_row) {
  if (at_row < 0) return;
  const Rotation between = inverse(motion.rotation[at(link.a)]) * motion.rotation[at(link.b)];
  value[at(at_row)] = bentSine(inverse(joints[link.index].reference) * between);
  if constexpr (kJacobian) setRow(at_row, link, {}, -1, 1);
}

template <bool kJacobian>
void JointConstraints::evaluateLimit(const JointMotion& motion, Link& link) {
  const int row = link.row[0];
  const Joint& joint = joints[link.index];
  const Rotation between = inverse(motion.rotation[at(link.a)]) * motion.rotation[at(link.b)];
  const double angle = angleOf(inverse(joint.reference) * between);
  if constexpr (kJacobian) {
    setRow(row, link, {}, -1, 1);
    const bool is_lower = angle - joint.lower < joint.upper - angle;
    const double new_low = is_lower ? 0 : -kNoLimit, new_high = is_lower ? kNoLimit : 0;
    if (new_low != low[at(row)] || new_high != high[at(row)]) side[at(row)] = is_lower ? -1 : 1;
    low[at(row)] = new_low;
    high[at(row)] = new_high;
    link.bound = is_lower ? joint.lower : joint.upper;
  }
  value[at(row)] = angle - link.bound;
}

template <bool kJacobian>
void JointConstraints::evaluate(const JointMotion& motion) {
  if (!kJacobian && !rods.empty()) {
    double* next = value.data();
    for (const Rod& rod : rods) {
      const Vec2 apart = motion.place[at(rod.b)] - motion.place[at(rod.a)];
      *next++ = (lengthSquared(apart) - rod.square) * rod.half_inverse_length;
    }
    return;
  }
  for (Link& link : links) {
    const int row = link.row[0];
    Vec2 apart = motion.place[at(link.b)] + link.arm_b;
    apart -= link.a >= 0 ? motion.place[at(link.a)] + link.arm_a : link.target;
    switch (link.kind) {
      case JointKind::kDistance:
      case JointKind::kRope:  // (d² − L²) / 2L needs no root, and is as good as d − L where it is 0
        value[at(row)] = (lengthSquared(apart) - link.length * link.length) * link.half_inverse_length;
        if constexpr (kJacobian) {
          const Vec2 n = (2 * link.half_inverse_length) * apart;
          setRow(row, link, n, -cross(link.arm_a, n), cross(link.arm_b, n));
        }
        break;
      case JointKind::kSpring:
        if (link.length > 0) {
          const double distance = length(apart);
          value[at(row)] = distance - link.length;
          if constexpr (kJacobian) {
            const Vec2 n = distance > 0 ? apart / distance : Vec2{1, 0};
            setRow(row, link, n, -cross(link.arm_a, n), cross(link.arm_b, n));
          }
          break;
        }
        [[fallthrough]];
      case JointKind::kHinge:
      case JointKind::kWeld:
      case JointKind::kMouse:
        value[at(row)] = apart.x;
        value[at(link.row[1])] = apart.y;
        if constexpr (kJacobian) {
          setRow(row, link, {1, 0}, link.arm_a.y, -link.arm_b.y);
          setRow(link.row[1], link, {0, 1}, -link.arm_a.x, link.arm_b.x);
        }
        if (link.kind == JointKind::kWeld) evaluateAngle<kJacobian>(motion, link, link.row[2]);
        break;
      case JointKind::kSlider: {
        const Vec2 n = perpendicular(motion.rotation[at(link.a)] * joints[link.index].axis);
        value[at(row)] = dot(n, apart);
        if constexpr (kJacobian) setRow(row, link, n, -cross(link.arm_a + apart, n), cross(link.arm_b, n));
        evaluateAngle<kJacobian>(motion, link, link.row[1]);
        break;
      }
      case JointKind::kMotor:
        value[at(row)] = 0;
        if constexpr (kJacobian) setRow(row, link, {}, -1, 1);
        break;
      case JointKind::kAngleLimit:
        evaluateLimit<kJacobian>(motion, link);
        break;
    }
  }
}

template void JointConstraints::evaluate<true>(const JointMotion& motion);
template void JointConstraints::evaluate<false>(const JointMotion& motion);

// A soft row's impulse s is the same in both halves of a stage, −h·k·(C + C′)/4 − c·(C′ − C)/2: the
// trapezoidal rule. Where h does not resolve the oscillation (h²·k over the effective mass above 4), backward
// Euler damps it instead of letting it ring.
void JointConstraints::prepare(const JointMotion& motion, double h) {
  constexpr double kIdle =
      1e-280;  // force per length: a row whose stiffness times h is below this exerts no force
  for (const int row : soft) {
    const Joint& joint = jointOf(row);
    const bool is_resolved = h < 0 || h * h * joint.stiffness * inverseEffectiveMass(motion, row) <= 4;
    const double now = is_resolved ? 0.25 * h * joint.stiffness : 0;
    const double push = (is_resolved ? 0.25 : 0.5) * h * joint.stiffness + 0.5 * joint.damping;
    value_before[at(row)] = value[at(row)];
    const bool is_idle = !(std::abs(push) > kIdle);
    softness[at(row)] = is_idle ? 0 : 1 / push;
    memory[at(row)] = is_idle ? 0 : (now - 0.5 * joint.damping) / push;
    diagonal[at(row)] = is_idle ? 0 : 1 / (push * h);
    is_out[at(row)] = is_idle || side[at(row)] != 0 ? 1 : 0;
    if (is_idle) multiplier[at(row)] = 0;
  }
  for (const int row : one_sided) {
    if (kind[at(row)] == Kind::kSoft || kind[at(row)] == Kind::kMotor) {
      const double most = 0.5 * std::abs(h) * jointOf(row).max_force;
      low[at(row)] = -most;
      high[at(row)] = most;
    }
    if (side[at(row)] != 0) multiplier[at(row)] = side[at(row)] < 0 ? low[at(row)] : high[at(row)];
    if (kind[at(row)] != Kind::kSoft) is_out[at(row)] = side[at(row)] != 0 ? 1 : 0;
  }
}

double JointConstraints::inverseEffectiveMass(const JointMotion& motion, int at_row) const {
  const JointRow& row = rows[at(at_row)];
  const JointMass& b = motion.mass[at(row.b)];
  double sum = b.inverse_mass + b.inverse_inertia * row.jb * row.jb;
  if (row.a < 0) return sum;
  const JointMass& a = motion.mass[at(row.a)];
  sum += a.inverse_mass + a.inverse_inertia * row.ja * row.ja;
  return sum;
}

double JointConstraints::targetSpeed(int at_row) const {
  return kind[at(at_row)] == Kind::kMotor ? jointOf(at_row).speed : 0;
}

double JointConstraints::residual(int at_row, const JointMotion& motion, double h) const {
  const std::size_t row = at(at_row);
  switch (kind[row]) {
    case Kind::kSoft:
      return value[row] + memory[row] * value_before[row] + softness[row] * multiplier[row];
    case Kind::kMotor:
      return h * (motion.speedAlong(rows[row]) - targetSpeed(at_row));
    default:
      return value[row];
  }
}

bool JointConstraints::changeActiveSet(const JointMotion& motion, double h, bool may_clamp,
                                       double tolerance) {
  bool has_changed = false;
  for (const int row : one_sided) {
    const double s = multiplier[at(row)];
    std::int8_t& its_side = side[at(row)];
    const std::int8_t before = its_side;
    if (its_side == 0) {
      if (may_clamp && s < low[at(row)]) its_side = -1;
      if (may_clamp && s > high[at(row)]) its_side = 1;
    } else if (its_side < 0 ? residual(row, motion, h) < -tolerance : residual(row, motion, h) > tolerance) {
      its_side = 0;
    }
    if (its_side == before) continue;
    has_changed = true;
    is_out[at(row)] = its_side != 0 ? 1 : 0;
    multiplier[at(row)] = its_side == 0 ? 0 : its_side < 0 ? low[at(row)] : high[at(row)];
  }
  return has_changed;
}

void JointConstraints::addForces(const std::vector<double>& impulse) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JointRow& row = rows[i];
    const std::size_t link = at(link_of[i]);
    force[link] += impulse[i] * row.n;
    if (row.n == Vec2{}) torque[link] += impulse[i] * row.jb;
  }
}

int JointConstraints::substepsOf(std::span<const Joint> all_joints, double h) const {
  constexpr double kTurn = 0.035;      // rad that a pulled body swings in a sub-step …
  constexpr double kMaxSubsteps = 72;  // … unless it would take more than this many
  double square = 0;
  for (const Link& link : links) {
    const Joint& joint = all_joints[at(link.index)];
    if (link.kind == JointKind::kMouse && joint.max_force == kNoLimit)
      square = std::max(square, h * h * joint.stiffness * link.pulled_inverse_mass);
  }
  return static_cast<int>(std::clamp(std::ceil(std::sqrt(square) / kTurn), 1.0, kMaxSubsteps));
}

bool JointConstraints::isCalm(std::span<const Joint> all_joints, double h) const {
  const double square = h * h;
  return std::none_of(links.begin(), links.end(), [&](const Link& link) {
    const double squared_force = lengthSquared(all_joints[at(link.index)].force);
    return square * square * squared_force > link.calm_force * link.calm_force;
  });
}

bool JointConstraints::mayCompose(const JointMotion& motion, std::span<const Joint> all_joints,
                                  double h) const {
  if (!one_sided.empty()) return false;
  for (const int row : soft) {
    const Joint& joint = all_joints[at(links[at(link_of[at(row)])].index)];
    const JointRow& its = rows[at(row)];
    const double inverse_mass =
        motion.mass[at(its.b)].inverse_mass + (its.a < 0 ? 0 : motion.mass[at(its.a)].inverse_mass);
    if (joint.damping > 0 || h * h * joint.stiffness * inverse_mass > 1) return false;
  }
  return true;
}

}  // namespace naiad::physics
