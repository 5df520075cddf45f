#include "physics/substep/SubstepJoints.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr float kJointDamping = 2;

// Used in place of every hinge: its rows depend only on its frame, so the joint itself is not read.
constexpr Joint kAnyHinge = [] {
  Joint joint;
  joint.kind = JointKind::kHinge;
  return joint;
}();

constexpr float kResolved = 0.25f;  // maximum (h·ω)² of an oscillation that sub-steps resolve

void take(const SubstepBody& of, float& inverse_mass, float& inverse_inertia) {
  if (of.state == 0) return;
  inverse_mass = of.inverse_mass;
  inverse_inertia = of.inverse_inertia;
}

void push(SubstepState& s, float inverse_mass, float inverse_inertia, float nx, float ny, float j,
          float impulse) {
  s.vx += inverse_mass * impulse * nx;
  s.vy += inverse_mass * impulse * ny;
  s.spin += inverse_inertia * impulse * j;
}

}  // namespace

void SubstepJoints::begin(std::span<SubstepBody> bodies, float h) {
  m_links.clear();
  m_rows.clear();
  m_h = h;
  m_softness = softnessOf(kFastestTurns, kJointDamping, h);
  for (const int id : ids()) {
    const Joint& j = joint(id);
    if (j.is_broken) continue;
    if (bodies[at(j.b)].state > 0 || (firstOf(j) >= 0 && bodies[at(j.a)].state > 0)) load(id, bodies);
  }
  stiffen(bodies);
  for (Link& link : m_links) {
    if (link.a >= 0) take(bodies[at(link.a)], link.inverse_mass_a, link.inverse_inertia_a);
    take(bodies[at(link.b)], link.inverse_mass_b, link.inverse_inertia_b);
    place(link, {}, {}, 0);
  }
}

// Adds inertia to bodies that oscillate faster than sub-steps can resolve, as much as backward Euler would. A
// body that is pulled at both ends oscillates about its centre, and faster if the pull is stronger. (S.
// Andrews, M. Teichmann, P. Kry, "Geometric stiffness for real-time constrained multibody dynamics", 2017.)
void SubstepJoints::stiffen(std::span<SubstepBody> bodies) {
  for (const Link& link : m_links) {
    const Memory& memory = memoryOf(link.id);
    const bool holds_point = link.count > 1 && !isAngleRow(joint(link.id).kind, 1);
    const auto along = static_cast<float>(memory[0]),
               across = holds_point ? static_cast<float>(memory[1]) : 0;
    const float force = std::sqrt(along * along + across * across);
    const auto add = [&](int id, Vec2 arm) {
      if (id >= 0) bodies[at(id)].pull += m_h * m_h * force * static_cast<float>(length(arm));
    };
    add(link.a, link.frame.arm_a);
    add(link.b, link.frame.arm_b);
  }
  const auto slow = [&](int id) {
    if (id < 0) return;
    SubstepBody& b = bodies[at(id)];
    const float swing = b.pull * b.inverse_inertia;  // (h·ω)²
    if (swing > kResolved) b.inverse_inertia /= 1 + (swing - kResolved);
    b.pull = 0;
  };
  for (const Link& link : m_links) {
    slow(link.a);
    slow(link.b);
  }
}

void SubstepJoints::load(int id, std::span<const SubstepBody> bodies) {
  const Joint& j = joint(id);
  const SubstepBody& b = bodies[at(j.b)];
  Link link = {};
  link.id = id;
  link.a = firstOf(j);
  link.b = j.b;
  link.state_b = b.state;
  link.row = static_cast<int>(m_rows.size());
  link.count = rowsOf(j);
  link.is_hinge = j.kind == JointKind::kHinge;
  link.is_point = link.is_hinge || j.kind == JointKind::kWeld;
  link.frame.arm_b = b.body.rotation * j.anchor_b;
  link.velocity = b.body.velocity;
  if (link.a >= 0) {
    const SubstepBody& a = bodies[at(j.a)];
    link.state_a = a.state;
    link.frame.arm_a = a.body.rotation * j.anchor_a;
    link.frame.axis = a.body.rotation * j.axis;
    link.frame.offset = b.body.place - a.body.place;
    link.frame.between = inverse(j.reference) * (inverse(a.body.rotation) * b.body.rotation);
    link.velocity -= a.body.velocity;
  } else {
    link.frame.offset = b.body.place - j.target;
  }
  m_links.push_back(link);
  for (int k = 0; k < link.count; ++k) {
    Row row;
    row.impulse = static_cast<float>(memoryOf(id)[at(k)]) * m_h;
    row.is_spring = j.kind == JointKind::kSpring || j.kind == JointKind::kMouse;
    row.is_angle = isAngleRow(j.kind, k);
    m_rows.push_back(row);
  }
}

void SubstepJoints::place(Link& link, const SubstepState& a, const SubstepState& b, float time) {
  const Rotation turn_a = {a.c, a.s}, turn_b = {b.c, b.s};
  JointFrame frame;
  frame.arm_a = turn_a * link.frame.arm_a;
  frame.arm_b = turn_b * link.frame.arm_b;
  frame.offset = link.frame.offset + time * link.velocity + Vec2{double{b.x} - a.x, double{b.y} - a.y} +
                 (frame.arm_b - frame.arm_a);
  const Joint& j = link.is_hinge ? kAnyHinge : joint(link.id);
  if (!link.is_hinge) {
    frame.axis = turn_a * link.frame.axis;
    frame.between = link.frame.between * (inverse(turn_a) * turn_b);
  }
  SpeedRows placed;
  placeRows(j, frame, placed);
  for (int k = 0; k < link.count; ++k) {
    Row& row = m_rows[at(link.row + k)];
    const SpeedRow& from = placed[at(k)];
    row.nx = static_cast<float>(from.n.x), row.ny = static_cast<float>(from.n.y);
    row.ja = static_cast<float>(from.ja), row.jb = static_cast<float>(from.jb);
    row.value = static_cast<float>(from.value);
    row.side = static_cast<std::int8_t>(from.side);
    row.speed = static_cast<float>(dot(from.n, link.velocity));
    const float inverse = (link.inverse_mass_a + link.inverse_mass_b) * (row.nx * row.nx + row.ny * row.ny) +
                          link.inverse_inertia_a * row.ja * row.ja + link.inverse_inertia_b * row.jb * row.jb;
    row.mass = inverse > 0 ? 1 / inverse : 0;
    prepare(row, j);
  }
  if (!link.is_point) return;
  const Row &x = m_rows[at(link.row)], &y = m_rows[at(link.row + 1)];
  const float between = link.inverse_inertia_a * x.ja * y.ja + link.inverse_inertia_b * x.jb * y.jb;
  const float xx = x.mass > 0 ? 1 / x.mass : 0, yy = y.mass > 0 ? 1 / y.mass : 0;
  const float determinant = xx * yy - between * between;
  const float by = determinant > 0 ? 1 / determinant : 0;
  link.inverse_xx = yy * by, link.inverse_yy = xx * by, link.inverse_xy = -between * by;
}

void SubstepJoints::prepare(Row& row, const Joint& joint) const {
  const auto kUnbounded = static_cast<float>(kNoLimit);
  row.low = row.side > 0 ? 0 : -kUnbounded;
  row.high = row.side < 0 ? 0 : kUnbounded;
  if (joint.kind == JointKind::kMotor) {
    row.target = static_cast<float>(joint.speed);
    row.high = static_cast<float>(std::min(joint.max_force * m_h, 1e30));
    row.low = -row.high;
    row.is_spring = true;
    row.bias = 0, row.mass_scale = 1, row.impulse_scale = 0;
    return;
  }
  if (row.is_spring) {
    // Backward Euler is stable for any stiffness.
    const double k = joint.stiffness, c = joint.damping, h = m_h;
    const double hold = h * (c + h * k);
    const double softness = hold > 0 ? 1 / hold : kNoLimit;  // softness as an inverse mass
    if (row.mass == 0 || hold == 0) {
      row.mass_scale = row.impulse_scale = 0;
      return;
    }
    const double scale = 1 / (1 + softness * row.mass);
    row.bias = static_cast<float>(h * k / (c + h * k) / h * row.value);
    row.mass_scale = static_cast<float>(scale);
    row.impulse_scale = static_cast<float>(softness * row.mass * scale);
    if (joint.kind == JointKind::kMouse) {
      row.high = static_cast<float>(std::min(joint.max_force * h, 1e30));
      row.low = -row.high;
    }
    return;
  }
  const bool is_free = static_cast<float>(row.side) * row.value > 0;
  if (is_free) {  // the joint may reach its limit, but not pass it
    row.bias = row.value / m_h;
    row.mass_scale = 1, row.impulse_scale = 0;
    row.is_spring = false;
    return;
  }
  row.bias = m_softness.rate * row.value;
  row.mass_scale = m_softness.mass_scale;
  row.impulse_scale = m_softness.impulse_scale;
}

void SubstepJoints::warmStart(std::span<SubstepState> states) {
  for (const Link& link : m_links) {
    SubstepState &a = states[at(link.state_a)], &b = states[at(link.state_b)];
    for (int k = 0; k < link.count; ++k) {
      const Row& row = m_rows[at(link.row + k)];
      push(a, link.inverse_mass_a, link.inverse_inertia_a, -row.nx, -row.ny, row.ja, row.impulse);
      push(b, link.inverse_mass_b, link.inverse_inertia_b, row.nx, row.ny, row.jb, row.impulse);
    }
  }
}

// Solves the two rows that hold a point as one system.
void SubstepJoints::solvePoint(const Link& link, SubstepState& a, SubstepState& b, bool is_soft) {
  Row &x = m_rows[at(link.row)], &y = m_rows[at(link.row + 1)];
  const float mass_scale = is_soft ? x.mass_scale : 1, impulse_scale = is_soft ? x.impulse_scale : 0;
  const auto missing = [&](const Row& row) {
    const float speed =
        row.speed + row.nx * (b.vx - a.vx) + row.ny * (b.vy - a.vy) + row.jb * b.spin + row.ja * a.spin;
    return -(speed + (is_soft ? row.bias : 0));
  };
  const float by_x = missing(x), by_y = missing(y);
  const float more_x =
      mass_scale * (link.inverse_xx * by_x + link.inverse_xy * by_y) - impulse_scale * x.impulse;
  const float more_y =
      mass_scale * (link.inverse_xy * by_x + link.inverse_yy * by_y) - impulse_scale * y.impulse;
  x.impulse += more_x;
  y.impulse += more_y;
  push(a, link.inverse_mass_a, link.inverse_inertia_a, -x.nx, -x.ny, x.ja, more_x);
  push(b, link.inverse_mass_b, link.inverse_inertia_b, x.nx, x.ny, x.jb, more_x);
  push(a, link.inverse_mass_a, link.inverse_inertia_a, -y.nx, -y.ny, y.ja, more_y);
  push(b, link.inverse_mass_b, link.inverse_inertia_b, y.nx, y.ny, y.jb, more_y);
}

void SubstepJoints::solveRow(const Link& link, Row& row, SubstepState& a, SubstepState& b, bool is_soft) {
  if (row.is_spring && !is_soft) return;  // springs are solved in the soft solution only
  const bool is_free = static_cast<float>(row.side) * row.value > 0;
  const bool has_bias = is_soft || is_free;
  const float bias = has_bias ? row.bias : 0;
  const float mass_scale = has_bias ? row.mass_scale : 1, impulse_scale = has_bias ? row.impulse_scale : 0;
  const float speed = row.speed + row.nx * (b.vx - a.vx) + row.ny * (b.vy - a.vy) + row.jb * b.spin +
                      row.ja * a.spin - row.target;
  const float wanted = row.impulse - row.mass * mass_scale * (speed + bias) - impulse_scale * row.impulse;
  const float now = std::min(std::max(wanted, row.low), row.high);
  const float more = now - row.impulse;
  row.impulse = now;
  push(a, link.inverse_mass_a, link.inverse_inertia_a, -row.nx, -row.ny, row.ja, more);
  push(b, link.inverse_mass_b, link.inverse_inertia_b, row.nx, row.ny, row.jb, more);
}

void SubstepJoints::solve(const Link& link, SubstepState& a, SubstepState& b, bool is_soft) {
  int k = link.count;
  while (k > (link.is_point ? 2 : 0)) solveRow(link, m_rows[at(link.row + --k)], a, b, is_soft);
  if (link.is_point) solvePoint(link, a, b, is_soft);
}

void SubstepJoints::solveSoftly(std::span<SubstepState> states) {
  for (const Link& link : m_links) solve(link, states[at(link.state_a)], states[at(link.state_b)], true);
}

void SubstepJoints::relax(std::span<SubstepState> states, float time) {
  for (Link& link : m_links) {
    SubstepState &a = states[at(link.state_a)], &b = states[at(link.state_b)];
    place(link, a, b, time);
    solve(link, a, b, false);
    for (int k = 0; k < link.count; ++k) {
      const Row& row = m_rows[at(link.row + k)];
      if (row.is_angle) {
        link.torque += row.impulse;
      } else {
        link.force += row.impulse * Vec2{row.nx, row.ny};
      }
    }
  }
}

int SubstepJoints::end(double dt) {
  int broken = 0;
  for (const Link& link : m_links) {
    for (int k = 0; k < link.count; ++k)
      memoryOf(link.id)[at(k)] = double{m_rows[at(link.row + k)].impulse / m_h};
    broken += finish(link.id, link.force / dt, link.torque / dt) ? 1 : 0;
  }
  return broken;
}

}  // namespace naiad::physics
