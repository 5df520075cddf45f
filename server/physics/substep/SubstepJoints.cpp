#include "physics/substep/SubstepJoints.h"

#include <algorithm>
#include <array>
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
constexpr int kMaxLoops = 8;        // a system with more loops would cost too much
// Springs in a net, where each is solved alone. The sweeps' delay would let stiff ones oscillate without end,
// so they are at most as stiff as hard joints, and damped like those.
constexpr double kNetTurns = 1;    // maximum (h·ω)²
constexpr double kNetDamping = 4;  // minimum damping of a stiff spring, as a multiple of h·stiffness
constexpr double kNetSoft = 0.2;   // springs with a smaller (h·ω)² are damped less

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

void SubstepJoints::begin(std::span<const SubstepBody> bodies, float h) {
  m_links.clear();
  m_loads.clear();
  m_rows.clear();
  m_shapes.swap(m_shapes_before);
  m_shapes.clear();
  m_h = h;
  m_softness = softnessOf(kFastestTurns, kJointDamping, h);
  for (const int id : ids()) {
    const Joint& j = joint(id);
    if (j.is_broken) continue;
    if (bodies[at(j.b)].state > 0 || (firstOf(j) >= 0 && bodies[at(j.a)].state > 0)) load(id, bodies);
  }
  if (!m_links.empty()) weigh(bodies);
}

void SubstepJoints::makeRows(std::span<SubstepBody> bodies) {
  if (m_shapes != m_shapes_before) findSystems(bodies.size());
  for (std::size_t i = 0; i < m_links.size(); ++i) {
    Link& link = m_links[i];
    const Slot& slot = m_slots[i];
    link.p_system = slot.p_system;
    link.row = slot.row;
    link.is_in_net = slot.is_in_net;
    if (link.p_system == nullptr) makeRowsOf(link);
  }
  stiffen(bodies);
  for (Link& link : m_links) {
    if (link.a >= 0) take(bodies[at(link.a)], link.inverse_mass_a, link.inverse_inertia_a);
    take(bodies[at(link.b)], link.inverse_mass_b, link.inverse_inertia_b);
    place(link, {}, {}, 0);
  }
  for (std::size_t i = 0; i < m_loads.size(); ++i) {
    m_loads[i].p_system = m_slots[m_links.size() + i].p_system;
    m_loads[i].row = m_slots[m_links.size() + i].row;
    placeLoad(m_loads[i], {}, {}, 0);
  }
  for (auto& [first, system] : m_systems) {
    m_states.clear();
    m_masses.clear();
    for (const int id : system.bodies) {
      const SubstepBody& b = bodies[at(id)];
      m_states.push_back(b.state);
      m_masses.push_back(b.state > 0 ? JointMass{b.inverse_mass, b.inverse_inertia} : JointMass{});
    }
    system.rows.begin(m_states, m_masses);
  }
}

// Divides links and loads into systems, and those that are solved alone. Call only if they have changed.
void SubstepJoints::findSystems(std::size_t bodies) {
  std::map<int, System> old;
  old.swap(m_systems);
  m_slots.assign(m_shapes.size(), {});
  m_local_of.assign(bodies, -1);
  UnionFind sets;  // also by loads, unlike m_sets
  sets.reset(bodies);
  for (const Shape& shape : m_shapes) {
    if (shape.moves_a && shape.moves_b) sets.unite(shape.a, shape.b);
  }
  std::vector<std::pair<int, int>> by_root;  // (root, link)
  for (const Shape& s : m_shapes) {
    const int link = static_cast<int>(by_root.size());  // alone if it has no moving body
    by_root.emplace_back(s.moves_b ? sets.rootOf(s.b) : s.moves_a ? sets.rootOf(s.a) : -1 - link, link);
  }
  std::sort(by_root.begin(), by_root.end());
  for (auto first = by_root.begin(); first != by_root.end();) {
    const auto last =
        std::find_if(first, by_root.end(), [&](const auto& next) { return next.first != first->first; });
    const std::span<const std::pair<int, int>> links(first, last);
    if (isDirect(links)) {
      addSystem(links, old);
    } else {
      for (const auto& [root, link] : links) m_slots[at(link)].is_in_net = links.size() > 1;
    }
    first = last;
  }
}

// True if these connected links are several, with at most kMaxLoops loops, not counting those of loads.
bool SubstepJoints::isDirect(std::span<const std::pair<int, int>> links) const {
  if (links.size() < 2) return false;
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> bodies;
  for (const auto& [root, link] : links) {
    const Shape& shape = m_shapes[at(link)];
    if (shape.id < 0) continue;
    if (shape.moves_b) bodies.push_back(shape.b);
    if (shape.moves_a) bodies.push_back(shape.a);
    if (shape.moves_a && shape.moves_b) pairs.emplace_back(std::minmax(shape.a, shape.b));
  }
  const auto countOf = [](auto& all) {
    std::sort(all.begin(), all.end());
    return std::unique(all.begin(), all.end()) - all.begin();
  };
  return countOf(pairs) - countOf(bodies) + 1 <= kMaxLoops;
}

void SubstepJoints::addSystem(std::span<const std::pair<int, int>> links, std::map<int, System>& old) {
  const int first = m_shapes[at(links.front().second)].id;
  System& system = m_systems[first];
  std::vector<int> key, bodies;
  std::vector<JointRow> rows;
  const auto localOf = [&](int id) {
    if (m_local_of[at(id)] < 0) {
      m_local_of[at(id)] = static_cast<int>(bodies.size());
      bodies.push_back(id);
    }
    return m_local_of[at(id)];
  };
  m_masses.clear();
  for (const auto& [root, link] : links) {
    const Shape& shape = m_shapes[at(link)];
    m_slots[at(link)] = {&system.rows, static_cast<int>(rows.size()), false};
    const int a = shape.a >= 0 ? localOf(shape.a) : -1, b = localOf(shape.b);
    m_masses.resize(bodies.size());
    if (shape.a >= 0) m_masses[at(a)] = {shape.moves_a ? 1.0 : 0.0, 0};
    m_masses[at(b)] = {shape.moves_b ? 1.0 : 0.0, 0};
    rows.insert(rows.end(), at(shape.rows), {{}, 0, 0, a, b});
    key.insert(key.end(),
               {shape.id, shape.a, shape.b, shape.rows, shape.moves_a ? 1 : 0, shape.moves_b ? 1 : 0});
  }
  for (const int id : bodies) m_local_of[at(id)] = -1;
  const auto before = old.find(first);
  if (before != old.end() && before->second.rows.isBuiltFor(key)) {
    system = std::move(before->second);
  } else {
    system.rows.build(key, rows, m_masses);
  }
  system.bodies = std::move(bodies);
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
  link.count = rowsOf(j);
  link.is_hinge = j.kind == JointKind::kHinge;
  link.is_line = link.count == 1 && (j.kind == JointKind::kDistance || j.kind == JointKind::kRope ||
                                     j.kind == JointKind::kSpring);
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
  const auto isDriven = [&](int body) {
    const RigidBody& of = bodies[at(body)].body;
    return !isMovable(of) && (of.velocity != Vec2{} || of.spin != 0);
  };
  const bool has_spring = j.kind == JointKind::kSpring || j.kind == JointKind::kMouse;
  if (isDriven(link.b)) link.driver = b.body.velocity;
  if (link.a >= 0 && isDriven(link.a)) link.driver = bodies[at(link.a)].body.velocity;
  link.is_driven = isDriven(link.b) || (link.a >= 0 && isDriven(link.a));
  link.has_work = link.is_driven || has_spring || j.kind == JointKind::kMotor;
  m_links.push_back(link);
  const auto moves = [&](int body) {
    return body >= 0 && bodies[at(body)].state > 0 && isMovable(bodies[at(body)]);
  };
  m_shapes.push_back({id, link.a, link.b, moves(link.a), moves(link.b), link.count + (link.is_line ? 1 : 0)});
}

void SubstepJoints::makeRowsOf(Link& link) {
  const Joint& j = joint(link.id);
  link.row = static_cast<int>(m_rows.size());
  for (int k = 0; k < link.count; ++k) {
    Row row;
    row.impulse = static_cast<float>(memoryOf(link.id)[at(k)]) * m_h;
    row.is_spring =
        j.kind == JointKind::kSpring || j.kind == JointKind::kMouse || j.kind == JointKind::kMotor;
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
    const SpeedRow& from = placed[at(k)];
    const Law law = lawOf(j, from);
    link.value[at(k)] = from.value;
    if (link.p_system != nullptr) {
      setSystemRow(link, k, from, law);
      continue;
    }
    Row& row = m_rows[at(link.row + k)];
    row.nx = static_cast<float>(from.n.x), row.ny = static_cast<float>(from.n.y);
    row.ja = static_cast<float>(from.ja), row.jb = static_cast<float>(from.jb);
    row.value = static_cast<float>(from.value);
    row.side = static_cast<std::int8_t>(from.side);
    row.speed = static_cast<float>(dot(from.n, link.velocity));
    const float inverse = (link.inverse_mass_a + link.inverse_mass_b) * (row.nx * row.nx + row.ny * row.ny) +
                          link.inverse_inertia_a * row.ja * row.ja + link.inverse_inertia_b * row.jb * row.jb;
    row.mass = inverse > 0 ? 1 / inverse : 0;
    setRow(row, law);
    if (link.is_in_net && law.is_spring) soften(row, j);
  }
  if (link.is_line && link.p_system != nullptr) placeAcross(link, frame, placed[0].n);
  if (!link.is_point || link.p_system != nullptr) return;
  const Row &x = m_rows[at(link.row)], &y = m_rows[at(link.row + 1)];
  const float between = link.inverse_inertia_a * x.ja * y.ja + link.inverse_inertia_b * x.jb * y.jb;
  const float xx = x.mass > 0 ? 1 / x.mass : 0, yy = y.mass > 0 ? 1 / y.mass : 0;
  const float determinant = xx * yy - between * between;
  const float by = determinant > 0 ? 1 / determinant : 0;
  link.inverse_xx = yy * by, link.inverse_yy = xx * by, link.inverse_xy = -between * by;
}

// A taut line turns as if a spring held its ends in place across it. If the ends are so light that they
// oscillate faster than sub-steps can resolve, that spring is a row, too.
void SubstepJoints::placeAcross(const Link& link, const JointFrame& frame, Vec2 along) const {
  SubstepSystem& system = *link.p_system;
  const double h = m_h, force = -system.row(link.row).impulse / h;
  const double stiffness = force / length(frame.offset);
  const double inverse_mass = double{link.inverse_mass_a} + link.inverse_mass_b;
  const bool is_needed = h * h * stiffness * inverse_mass > kResolved;
  SubstepSystem::Row& row = system.row(link.row + link.count);
  const Vec2 n = perpendicular(along);
  row.speed = dot(n, link.velocity);
  row.softness = is_needed ? 1 / (h * h * stiffness) : 0;
  row.high = is_needed ? kNoLimit : 0;
  row.low = -row.high;
  row.is_spring = true;
  system.place(link.row + link.count, n, -cross(frame.arm_a, n), cross(frame.arm_b, n));
}

SubstepJoints::Law SubstepJoints::lawOf(const Joint& joint, const SpeedRow& row) const {
  Law law;
  law.low = row.side > 0 ? 0 : -kNoLimit;
  law.high = row.side < 0 ? 0 : kNoLimit;
  const double h = m_h;
  if (joint.kind == JointKind::kMotor) {
    law.target = joint.speed;
    law.high = joint.max_force * h;
    law.low = -law.high;
  } else if (joint.kind == JointKind::kSpring || joint.kind == JointKind::kMouse) {
    // Backward Euler is stable for any stiffness.
    const double k = joint.stiffness, c = joint.damping, hold = h * (c + h * k);
    law.is_spring = true;
    if (joint.kind == JointKind::kMouse) {
      law.high = joint.max_force * h;
      law.low = -law.high;
    }
    if (hold > 0) {
      law.softness = 1 / hold;
      law.bias = k / (c + h * k) * row.value;
    } else {
      law.low = law.high = 0;
    }
  } else {
    law.is_limit = row.side * row.value > 0;  // the joint may reach its limit, but not pass it
    law.bias = law.is_limit ? row.value / h : double{m_softness.rate} * row.value;
  }
  return law;
}

void SubstepJoints::setSystemRow(const Link& link, int k, const SpeedRow& from, const Law& law) {
  SubstepSystem::Row& row = link.p_system->row(link.row + k);
  row.speed = dot(from.n, link.velocity);
  row.target = law.target;
  row.bias = law.bias;
  row.softness = law.softness;
  row.low = law.low, row.high = law.high;
  row.is_spring = law.is_spring;
  row.is_limit = law.is_limit;
  link.p_system->place(link.row + k, from.n, from.ja, from.jb);
}

void SubstepJoints::setRow(Row& row, const Law& law) const {
  constexpr double kMost = 1e30;
  row.low = static_cast<float>(std::max(law.low, -kMost)),
  row.high = static_cast<float>(std::min(law.high, kMost));
  row.target = static_cast<float>(law.target);
  row.bias = static_cast<float>(law.bias);
  row.is_limit = law.is_limit;
  if (law.is_spring) {
    const double soft = law.softness * row.mass, scale = 1 / (1 + soft);
    const bool works = row.mass > 0 && law.softness > 0;
    row.mass_scale = works ? static_cast<float>(scale) : 0;
    row.impulse_scale = works ? static_cast<float>(soft * scale) : 0;
    return;
  }
  const bool is_hard = law.is_limit || row.is_spring;  // row.is_spring: a motor
  row.mass_scale = is_hard ? 1 : m_softness.mass_scale;
  row.impulse_scale = is_hard ? 0 : m_softness.impulse_scale;
}

// Limits the stiffness of a spring in a net, and adds damping.
void SubstepJoints::soften(Row& row, const Joint& joint) const {
  const double h = m_h;
  if (row.mass == 0 || !(joint.stiffness > 0)) return;
  const double stiffest = kNetTurns * row.mass / (h * h);
  const double k = std::min(joint.stiffness, stiffest);
  const double part = std::min(h * h * joint.stiffness / (kNetSoft * row.mass), 1.0);
  const double least = kNetDamping * h * k * part, most = kNetDamping * h * stiffest;
  const double c = std::max(std::min(joint.damping, most), least);
  const double softness = row.mass / (h * (c + h * k)), scale = 1 / (1 + softness);
  row.bias = static_cast<float>(k / (c + h * k)) * row.value;
  row.mass_scale = static_cast<float>(scale);
  row.impulse_scale = static_cast<float>(softness * scale);
}

void SubstepJoints::warmStart(std::span<SubstepState> states) {
  for (auto& [first, system] : m_systems) system.rows.beginSubstep(states);
  for (const Link& link : m_links) {
    if (link.p_system != nullptr) continue;
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
  const bool has_bias = is_soft || row.is_limit;
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

void SubstepJoints::solveSoftly(std::span<SubstepState> states, ContactRows& rows) {
  takeLoads(rows);
  for (auto& [first, system] : m_systems) system.rows.solve(states, true);
  giveLoads(rows);
  for (const Link& link : m_links) {
    if (link.p_system == nullptr) solve(link, states[at(link.state_a)], states[at(link.state_b)], true);
  }
}

void SubstepJoints::relax(std::span<SubstepState> states, ContactRows& rows, float time) {
  for (Link& link : m_links) {
    const SubstepState &a = states[at(link.state_a)], &b = states[at(link.state_b)];
    link.work = 0;
    if (link.has_work) addWork(link, states, 1);
    const std::array<double, 3> before = link.value;
    place(link, a, b, time);
    if (link.has_work) {
      addStored(link, before);
      addWork(link, states, -1);
    }
    if (link.p_system == nullptr) solve(link, states[at(link.state_a)], states[at(link.state_b)], false);
  }
  for (const Load& load : m_loads) placeLoad(load, states[at(load.state_a)], states[at(load.state_b)], time);
  for (auto& [first, system] : m_systems) system.rows.solve(states, false);
  giveLoads(rows);
  for (Link& link : m_links) {
    if (link.has_work) addWork(link, states, 1);
    const Joint& j = joint(link.id);
    for (int k = 0; k < link.count; ++k) {
      const JointImpulse pushed = impulseOf(link, k);
      if (isAngleRow(j.kind, k)) {
        link.torque += pushed.size;
      } else {
        link.force += pushed.size * pushed.n;
      }
    }
  }
}

// Returns the impulse of a row in this sub-step.
SubstepJoints::JointImpulse SubstepJoints::impulseOf(const Link& link, int k) const {
  if (link.p_system != nullptr) {
    const JointRow& along = link.p_system->along(link.row + k);
    return {link.p_system->row(link.row + k).impulse, along.n, along.ja, along.jb};
  }
  const Row& row = m_rows[at(link.row + k)];
  return {row.impulse, {row.nx, row.ny}, row.ja, row.jb};
}

// Adds the work that motors and moving immovable bodies do by the impulses of this sub-step, at the present
// directions of the rows.
void SubstepJoints::addWork(Link& link, std::span<const SubstepState> states, double sign) const {
  const Joint& j = joint(link.id);
  if (j.kind != JointKind::kMotor && !link.is_driven) return;
  for (int k = 0; k < link.count; ++k) {
    const JointImpulse pushed = impulseOf(link, k);
    double speed = j.kind == JointKind::kMotor ? j.speed : 0;
    if (link.is_driven) {
      const bool is_b = link.inverse_mass_b + link.inverse_inertia_b == 0;
      const double spin = states[at(is_b ? link.state_b : link.state_a)].spin;
      speed -= is_b ? dot(pushed.n, link.driver) + pushed.jb * spin
                    : pushed.ja * spin - dot(pushed.n, link.driver);
    }
    link.work += sign * pushed.size * speed;
  }
}

// Adds the energy that a spring has released since its rows had these values.
void SubstepJoints::addStored(Link& link, const std::array<double, 3>& before) const {
  const Joint& j = joint(link.id);
  if (j.kind != JointKind::kSpring && j.kind != JointKind::kMouse) return;
  const double most = j.kind == JointKind::kMouse ? j.max_force : kNoLimit;
  const auto stored = [&](double value) {
    const double x = std::fabs(value), force = j.stiffness * x;
    return force <= most ? 0.5 * force * x : most * (x - 0.5 * most / j.stiffness);
  };
  for (int k = 0; k < link.count; ++k) link.work += stored(before[at(k)]) - stored(link.value[at(k)]);
}

void SubstepJoints::scale(std::span<const float> factors, std::span<SubstepState> states, ContactRows& rows) {
  takeLoads(rows);
  for (const Link& link : m_links) {
    if (link.p_system != nullptr) continue;
    const bool moves_b = link.inverse_mass_b + link.inverse_inertia_b > 0;
    const float by = factors[at(moves_b ? link.state_b : link.state_a)];
    if (by == 1) continue;
    for (int k = 0; k < link.count; ++k) m_rows[at(link.row + k)].impulse *= by;
    solve(link, states[at(link.state_a)], states[at(link.state_b)], false);
  }
  for (auto& [first, system] : m_systems) {
    if (system.rows.isScaled(factors)) system.rows.solve(states, false);
  }
  giveLoads(rows);
}

int SubstepJoints::end(double dt) {
  int broken = 0;
  for (const Link& link : m_links) {
    for (int k = 0; k < link.count; ++k) memoryOf(link.id)[at(k)] = impulseOf(link, k).size / double{m_h};
    broken += finish(link.id, link.force / dt, link.torque / dt) ? 1 : 0;
  }
  return broken;
}

}  // namespace naiad::physics
