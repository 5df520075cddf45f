// What a JointIsland is made of: its joints' rows, in the order in which they are eliminated.
#include <algorithm>
#include <cstddef>

#include "physics/joint/JointIsland.h"

namespace naiad::physics {

namespace {

constexpr double kCalm = 0.25;  // of (frequency · step)²: see JointIsland::isCalm

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

JointIsland::JointIsland(std::span<const int> bodies, std::span<const int> joints,
                         std::span<const JointBody> all_bodies, std::span<const Joint> all_joints)
    : m_body(bodies.begin(), bodies.end()) {
  for (const int body : bodies) {
    m_mass.push_back({all_bodies[at(body)].inverse_mass, all_bodies[at(body)].inverse_inertia});
  }
  const auto local = [&](int body) {
    const auto found = std::lower_bound(m_body.begin(), m_body.end(), body);
    return static_cast<int>(found - m_body.begin());
  };
  for (const int index : joints) {
    const Joint& joint = all_joints[at(index)];
    Link link = {};
    link.kind = joint.kind;
    link.index = index;
    link.a = joint.kind == JointKind::kMouse ? -1 : local(joint.a);
    link.b = local(joint.b);
    link.anchor_a = joint.anchor_a;
    link.anchor_b = joint.anchor_b;
    link.is_plain = joint.anchor_a == Vec2{} && joint.anchor_b == Vec2{};
    link.length = joint.length;
    link.half_inverse_length = joint.length > 0 ? 0.5 / joint.length : 0;
    const bool may_turn =
        m_mass[at(link.b)].inverse_inertia > 0 || (link.a >= 0 && m_mass[at(link.a)].inverse_inertia > 0);
    addRows(link, joint, may_turn);
    link.most_force = mostCalmForce(link, joint);
    m_links.push_back(link);
  }
  const std::vector<int> order = eliminationOrder(m_rows, m_mass);
  std::vector<int> rank(order.size());
  for (int i = 0; i < static_cast<int>(order.size()); ++i) rank[at(order[at(i)])] = i;
  const auto rows = m_rows;
  const auto kinds = m_kind;
  const auto links = m_link_of;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    m_rows[at(rank[i])] = rows[i];
    m_kind[at(rank[i])] = kinds[i];
    m_link_of[at(rank[i])] = links[i];
  }
  for (Link& link : m_links) {
    for (int& row : link.row) row = row < 0 ? row : rank[at(row)];
  }
  m_matrix.analyse(m_rows, m_mass);

  const std::size_t n = m_rows.size();
  for (auto* list :
       {&m_value, &m_value_before, &m_multiplier, &m_second, &m_rest, &m_softness, &m_memory, &m_diagonal}) {
    list->assign(n, 0);
  }
  m_low.assign(n, -kNoLimit);
  m_high.assign(n, kNoLimit);
  m_side.assign(n, 0);
  m_is_out.assign(n, 0);
  m_is_out_second.assign(n, 0);
  for (int row = 0; row < static_cast<int>(n); ++row) {
    const Joint& joint = all_joints[at(m_links[at(m_link_of[at(row)])].index)];
    const Kind kind = m_kind[at(row)];
    if (kind == Kind::kSoft) m_soft.push_back(row);
    if (kind == Kind::kRope || kind == Kind::kLimit || kind == Kind::kMotor ||
        (joint.kind == JointKind::kMouse && joint.max_force < kNoLimit)) {
      m_one_sided.push_back(row);
    }
    if (kind == Kind::kRope) m_high[at(row)] = 0;
    if (kind == Kind::kRope || kind == Kind::kLimit) m_side[at(row)] = 1;
    m_is_out[at(row)] = m_side[at(row)] != 0 ? 1 : 0;
  }
  m_is_smooth = m_one_sided.empty() && m_soft.empty();
  m_force.assign(m_links.size(), {});
  m_torque.assign(m_links.size(), 0);
  const std::size_t count = m_body.size();
  m_place.resize(count);
  m_velocity.resize(count);
  m_acceleration.resize(count);
  m_rotation.resize(count);
  m_spin.resize(count);
  m_turn_acceleration.resize(count);
  m_place_before = m_velocity_before = m_kicked = m_velocity;
  m_rotation_before = m_rotation;
  m_spin_before = m_spin_kicked = m_spin;
  const bool is_rods = std::all_of(m_links.begin(), m_links.end(), [](const Link& link) {
    return link.kind == JointKind::kDistance && link.is_plain;
  });
  if (is_rods) {
    m_rods.resize(n);
    for (const Link& link : m_links) {
      m_rods[at(link.row[0])] = {link.a, link.b, link.length * link.length, link.half_inverse_length};
    }
  }
  if (is_rods && m_matrix.isChain()) m_chain.connect(m_rods, m_mass);
  m_is_rod = m_links.size() == 1 && m_links[0].kind == JointKind::kDistance && m_links[0].is_plain &&
             m_mass[0].inverse_inertia == 0 && m_mass[1].inverse_inertia == 0;
}

void JointIsland::addRows(Link& link, const Joint& joint, bool may_turn) {
  const auto add = [&](int k, Kind kind) {
    link.row[k] = static_cast<int>(m_rows.size());
    m_rows.push_back({{}, 0, 0, link.a, link.b});
    m_kind.push_back(kind);
    m_link_of.push_back(static_cast<int>(m_links.size()));
  };
  link.row[0] = link.row[1] = link.row[2] = -1;
  switch (joint.kind) {
    case JointKind::kDistance:
      return add(0, Kind::kHard);
    case JointKind::kRope:
      return add(0, Kind::kRope);
    case JointKind::kMotor:
      return add(0, Kind::kMotor);
    case JointKind::kAngleLimit:
      return add(0, Kind::kLimit);
    case JointKind::kSpring:
      add(0, Kind::kSoft);
      if (joint.length == 0) add(1, Kind::kSoft);
      return;
    case JointKind::kMouse:
      add(0, Kind::kSoft);
      return add(1, Kind::kSoft);
    case JointKind::kHinge:
      add(0, Kind::kHard);
      return add(1, Kind::kHard);
    case JointKind::kWeld:
      add(0, Kind::kHard);
      add(1, Kind::kHard);
      if (may_turn) add(2, Kind::kHard);
      return;
    case JointKind::kSlider:
      add(0, Kind::kHard);
      if (may_turn) add(1, Kind::kHard);
      return;
  }
}

// The force that is still calm in a step of length one.
double JointIsland::mostCalmForce(const Link& link, const Joint& joint) const {
  const double arm_a = length(link.anchor_a), arm_b = length(link.anchor_b);
  const double arm = joint.length > 0 ? joint.length : std::max(arm_a, arm_b);
  if (!(arm > 0)) return kNoLimit;
  const JointMass b = m_mass[at(link.b)];
  double answer = b.inverse_mass + b.inverse_inertia * arm_b * arm_b;
  if (link.a >= 0) {
    answer += m_mass[at(link.a)].inverse_mass + m_mass[at(link.a)].inverse_inertia * arm_a * arm_a;
  }
  return answer > 0 ? kCalm * arm / answer : kNoLimit;
}

}  // namespace naiad::physics
