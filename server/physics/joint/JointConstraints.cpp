#include "physics/joint/JointConstraints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"

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

// Uses (d² − L²) / 2L, which needs no square root and equals d − L to first order near zero.
template <bool kJacobian>
void JointConstraints::evaluateRod(int at_row, const Link& link, Vec2 apart) {
  value[at(at_row)] = (lengthSquared(apart) - link.length * link.length) * link.half_inverse_length;
  if constexpr (!kJacobian) return;
  const Vec2 n = (2 * link.half_inverse_length) * apart;
  rows[at(at_row)] = {n, -cross(link.arm_a, n), cross(link.arm_b, n), link.a, link.b};
}

// Chooses the nearer bound when the Jacobian is computed. It does not change until the next Jacobian.
template <bool kJacobian>
void JointConstraints::chooseBound(int at_row, Link& link, const SpeedRow& placed) {
  const std::size_t row = at(at_row);
  const Joint& joint = joints[link.index];
  const double bound = placed.side > 0 ? joint.lower : joint.upper;
  if constexpr (kJacobian) {
    const double new_low = placed.side > 0 ? 0 : -kNoLimit, new_high = placed.side > 0 ? kNoLimit : 0;
    if (new_low != low[row] || new_high != high[row]) side[row] = placed.side > 0 ? -1 : 1;
    low[row] = new_low;
    high[row] = new_high;
    link.bound = bound;
  } else if (link.bound != bound) {
    value[row] += bound - link.bound;
  }
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
  JointFrame frame;
  SpeedRows placed;
  for (Link& link : links) {
    frame.arm_a = link.arm_a, frame.arm_b = link.arm_b;
    frame.offset = motion.place[at(link.b)] + link.arm_b;
    frame.offset -= link.a >= 0 ? motion.place[at(link.a)] + link.arm_a : link.target;
    if (link.kind == JointKind::kDistance || link.kind == JointKind::kRope) {
      evaluateRod<kJacobian>(link.row[0], link, frame.offset);
      continue;
    }
    if (!kJacobian && link.kind == JointKind::kHinge) {
      value[at(link.row[0])] = frame.offset.x;
      value[at(link.row[1])] = frame.offset.y;
      continue;
    }
    const Joint& joint = joints[link.index];
    if (link.holds_angle) {
      const Rotation& of_a = motion.rotation[at(link.a)];
      frame.axis = of_a * joint.axis;
      frame.between = inverse(joint.reference) * (inverse(of_a) * motion.rotation[at(link.b)]);
    }
    placeRows(joint, frame, placed);
    for (std::size_t k = 0; k < placed.size() && link.row[k] >= 0; ++k) {
      value[at(link.row[k])] = placed[k].value;
      if constexpr (kJacobian)
        rows[at(link.row[k])] = {placed[k].n, placed[k].ja, placed[k].jb, link.a, link.b};
    }
    if (link.kind == JointKind::kAngleLimit) chooseBound<kJacobian>(link.row[0], link, placed[0]);
  }
}

template void JointConstraints::evaluate<true>(const JointMotion& motion);
template void JointConstraints::evaluate<false>(const JointMotion& motion);

// A soft row has the same impulse s in both halves of a stage: −h·k·(C + C′)/4 − c·(C′ − C)/2, the
// trapezoidal rule. If h does not resolve the oscillation (h²·k over the effective mass is above 4), backward
// Euler is used instead, because it damps the oscillation.
void JointConstraints::prepare(const JointMotion& motion, double h) {
  constexpr double kIdle =
      1e-280;  // force per length: if stiffness times h is less than this, the row exerts no force
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
  constexpr double kTurn = 0.035;      // rad that a pulled body may swing in a sub-step
  constexpr double kMaxSubsteps = 72;  // limit of sub-steps, even if the body then swings farther in each
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
