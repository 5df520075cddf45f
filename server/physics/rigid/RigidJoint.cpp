#include "physics/rigid/RigidJoint.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr double kResolved = 1;  // maximum (h·ω)² of springs that may oscillate; others are damped
// Like kResolved, for springs on bodies whose rigid joints bend their path: otherwise the energy might grow.
constexpr double kResolvedHeld = 0.02;
constexpr double kLeastPush = 1e-280;  // smaller stiffness counts as 0, because its inverse is not finite

const RigidState kGround = {};

double speedOf(const RigidRow& row, const RigidState& a, const RigidState& b) {
  return dot(row.n, b.velocity - a.velocity) + row.jb * b.spin + row.ja * a.spin;
}

void push(const RigidRow& row, std::span<RigidState> states, double impulse) {
  if (row.a >= 0) {
    RigidState& a = states[at(row.a)];
    a.velocity -= (a.inverse_mass * impulse) * row.n;
    a.spin += a.inverse_inertia * row.ja * impulse;
  }
  RigidState& b = states[at(row.b)];
  b.velocity += (b.inverse_mass * impulse) * row.n;
  b.spin += b.inverse_inertia * row.jb * impulse;
}

// Prepares a row of a rigid joint. Its RigidLinkage undoes errors of positions.
void prepareHard(RigidRow& row, double h) {
  const double mass = row.inverse_effective_mass > 0 ? 1 / row.inverse_effective_mass : 0;
  // A one-sided row whose value is on the free side may reach the value 0, but not pass it. If it did not
  // reach 0 in the first half, it does nothing in the second one.
  const bool is_free = row.side * row.value > 0, is_idle = is_free && row.impulse == 0;
  const double low = row.side > 0 ? 0 : -kNoLimit, high = row.side < 0 ? 0 : kNoLimit;
  row.half[0] = {is_free ? -row.value / h : 0, 0, mass, low, high, 0};
  row.half[1] = {is_free ? -row.value / h : 0, 0, is_idle ? 0 : mass, low, high, 0};
  if (is_idle) row.warm = 0;
}

void prepareMotor(RigidRow& row, const Joint& joint, double h) {
  const double mass = row.inverse_effective_mass > 0 ? 1 / row.inverse_effective_mass : 0,
               most = joint.max_force * h;
  row.half[0] = {joint.speed, 0, mass, -0.5 * most, 0.5 * most, 0};
  row.half[1] = {joint.speed, 0, mass, -most, most, 0};
}

// Prepares a spring. If the sub-step resolves its oscillation, half of its impulse acts before the bodies
// move and half after, like gravity: the implicit midpoint rule, which conserves the energy of an undamped
// spring. A stiffer spring has all of its impulse before, by backward Euler.
void prepareSoft(RigidRow& row, const Joint& joint, double h, double resolved) {
  const double k = joint.stiffness, c = joint.damping;
  const double most = joint.kind == JointKind::kMouse ? joint.max_force * h : kNoLimit;
  for (int half = 0; half < 2; ++half) {
    RigidRowHalf& part = row.half[at(half)];
    part = {};
    part.low = half == 0 ? -0.5 * most : -most;
    part.high = -part.low;
    const auto soften = [&](double target, double softness) {
      part.target = target;
      part.softness = softness;
      part.mass = row.inverse_effective_mass + softness > 0 ? 1 / (row.inverse_effective_mass + softness) : 0;
    };
    if (h * h * k * row.inverse_effective_mass > resolved ||
        2 * h * c * row.inverse_effective_mass > kResolved) {
      part.low = -most, part.high = most;
      if (half == 0) soften(-k * row.value / (c + h * k), 1 / (h * (c + h * k)));
    } else if (half == 1) {
      part.given = row.impulse;
    } else if (const double push = 0.25 * h * h * k + 0.5 * h * c; push > kLeastPush) {
      soften(-0.5 * h * k * row.value / push, 1 / push);
    }
  }
}

}  // namespace

void RigidJoints::load(int id, std::span<const RigidBody> bodies) {
  const Joint& j = joint(id);
  const RigidBody& b = bodies[at(j.b)];
  Link link = {};
  link.id = id;
  link.kind = j.kind;
  link.a = firstOf(j);
  link.b = j.b;
  link.row = static_cast<int>(m_rows.size());
  link.count = rowsOf(j);
  link.arm_b = b.rotation * j.anchor_b;
  if (link.a >= 0) {
    const RigidBody& a = bodies[at(j.a)];
    link.arm_a = a.rotation * j.anchor_a;
    link.axis = a.rotation * j.axis;
    link.offset = b.place - a.place;
    link.between = inverse(j.reference) * (inverse(a.rotation) * b.rotation);
  } else {
    link.offset = b.place - j.target;
  }
  if (at(id) >= m_link_of.size()) m_link_of.resize(at(id) + 1, -1);
  m_link_of[at(id)] = static_cast<int>(m_links.size());
  m_links.push_back(link);
  for (int k = 0; k < link.count; ++k) {
    RigidRow row;
    row.a = link.a, row.b = link.b;
    row.impulse = memoryOf(id)[at(k)];  // divided by h until begin() multiplies it
    row.is_soft = j.kind == JointKind::kSpring || j.kind == JointKind::kMouse;
    m_rows.push_back(row);
  }
}

void RigidJoints::refresh(std::span<const RigidState> states) {
  for (const Link& link : m_links) {
    place(link, link.a >= 0 ? states[at(link.a)] : kGround, states[at(link.b)]);
  }
}

void RigidJoints::place(const Link& link, const RigidState& a, const RigidState& b) {
  const Joint& j = joint(link.id);
  JointFrame frame;
  frame.arm_a = a.turn * link.arm_a;
  frame.arm_b = b.turn * link.arm_b;
  frame.offset = link.offset + (b.displacement - a.displacement) + (frame.arm_b - frame.arm_a);
  frame.axis = a.turn * link.axis;
  frame.between = link.between * (inverse(a.turn) * b.turn);
  SpeedRows rows;
  placeRows(j, frame, rows);
  for (int k = 0; k < link.count; ++k) {
    RigidRow& row = m_rows[at(link.row + k)];
    static_cast<SpeedRow&>(row) = rows[at(k)];
    row.inverse_effective_mass = (a.inverse_mass + b.inverse_mass) * lengthSquared(row.n) +
                                 a.inverse_inertia * row.ja * row.ja + b.inverse_inertia * row.jb * row.jb;
  }
}

void RigidJoints::prepare(double h) {
  for (const Link& link : m_links) {
    const Joint& j = joint(link.id);
    for (int k = 0; k < link.count; ++k) {
      RigidRow& row = m_rows[at(link.row + k)];
      if (link.kind == JointKind::kMotor) {
        prepareMotor(row, j, h);
      } else if (row.is_soft) {
        prepareSoft(row, j, h, wayOf(link.id) == Way::kHeld ? kResolvedHeld : kResolved);
      } else {
        prepareHard(row, h);
      }
    }
  }
}

void RigidJoints::beginFirstHalf(std::span<RigidState> states, double h) {
  for (RigidRow& row : m_rows) {
    row.warm = row.is_soft ? 0 : 0.5 * row.impulse;
    row.impulse = 0;
  }
  prepareWarm(states, h, false);
}

void RigidJoints::beginSecondHalf(std::span<RigidState> states, double h) {
  prepareWarm(states, h, true);
}

void RigidJoints::prepareWarm(std::span<RigidState> states, double h, bool is_second) {
  for (RigidRow& row : m_rows) row.before = row.impulse;
  prepare(h);
  for (RigidRow& row : m_rows) {
    const RigidRowHalf& half = row.half[is_second];
    const double more =
        std::clamp(row.impulse + (row.is_soft ? half.given : row.warm), half.low, half.high) - row.impulse;
    row.impulse += more;
    push(row, states, more);
  }
}

double RigidJoints::solve(int link, std::span<RigidState> states, bool is_second) {
  double change = 0;
  for (RigidRow& row : rowsOfLink(link)) {
    const RigidRowHalf& half = row.half[is_second];
    if (half.mass == 0) continue;
    const double missing = half.target -
                           speedOf(row, row.a >= 0 ? states[at(row.a)] : kGround, states[at(row.b)]) -
                           half.softness * (row.impulse - row.before);
    const double impulse = std::clamp(row.impulse + half.mass * missing, half.low, half.high);
    const double more = impulse - row.impulse;
    row.impulse = impulse;
    push(row, states, more);
    change = std::max(change, std::fabs(more) / half.mass);
  }
  return change;
}

void RigidJoints::restart(int link, std::span<RigidState> states, bool is_second, double part) {
  for (RigidRow& row : rowsOfLink(link)) {
    const RigidRowHalf& half = row.half[is_second];
    const double guess = row.is_soft ? half.given : part * row.warm;
    row.impulse = std::clamp(row.before + guess, half.low, half.high);
    push(row, states, row.impulse - row.before);
  }
}

void RigidJoints::scale(int link, double part) {
  for (RigidRow& row : rowsOfLink(link)) row.impulse = row.before + part * (row.impulse - row.before);
}

double RigidJoints::inputOf(int link, std::span<const RigidState> states, bool is_second) {
  double input = 0;
  for (const RigidRow& row : rowsOfLink(link)) {
    const double impulse = row.impulse - row.before;
    if (impulse == 0) continue;
    double driven = 0,
           moved = 0;  // speeds along the row: of what no impulse changes, and the mean of the rest
    const auto add = [&](const RigidState& s, double sign, double lever) {
      const double along = sign * dot(row.n, s.velocity + s.velocity_before),
                   turn = lever * (s.spin + s.spin_before);
      (s.inverse_mass > 0 ? moved : driven) += 0.5 * along;
      (s.inverse_inertia > 0 ? moved : driven) += 0.5 * turn;
    };
    if (row.a >= 0) add(states[at(row.a)], -1, row.ja);
    add(states[at(row.b)], 1, row.jb);
    input += impulse * (row.is_soft ? moved : row.half[is_second].target - driven);
  }
  return input;
}

void RigidJoints::hold(std::span<RigidState> states) const {
  for (const RigidRow& row : m_rows) {
    if (row.is_soft || row.side != 0 || row.inverse_effective_mass == 0) continue;
    const RigidState& a = row.a >= 0 ? states[at(row.a)] : kGround;
    const RigidState& b = states[at(row.b)];
    if (!a.is_pushed && !b.is_pushed) continue;
    const double speed = dot(row.n, b.push - a.push) + row.jb * b.push_spin + row.ja * a.push_spin;
    const double impulse = -speed / row.inverse_effective_mass;
    const auto give = [&](RigidState& s, double sign, double lever) {
      if (s.inverse_mass == 0 && s.inverse_inertia == 0) return;
      s.push += (sign * s.inverse_mass * impulse) * row.n;
      s.push_spin += s.inverse_inertia * lever * impulse;
      s.is_pushed = true;
    };
    if (row.a >= 0) give(states[at(row.a)], -1, row.ja);
    give(states[at(row.b)], 1, row.jb);
  }
}

void RigidJoints::endSubstep() {
  for (Link& link : m_links) {
    for (int k = 0; k < link.count; ++k) {
      const RigidRow& row = m_rows[at(link.row + k)];
      if (isAngleRow(link.kind, k)) {
        link.torque += row.impulse;
      } else {
        link.force += row.impulse * row.n;
      }
    }
  }
}

int RigidJoints::end(double dt, double h) {
  int broken = 0;
  for (const Link& link : m_links) {
    if (link.is_done) continue;
    for (int k = 0; k < link.count; ++k) memoryOf(link.id)[at(k)] = m_rows[at(link.row + k)].impulse / h;
    broken += finish(link.id, link.force / dt, link.torque / dt) ? 1 : 0;
  }
  return broken;
}

}  // namespace naiad::physics
