// Makes the rows of JointConstraints from joints, and puts them into elimination order.
#include <algorithm>
#include <cassert>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/joint/JointConstraints.h"

namespace naiad::physics {

namespace {

// Limit of (frequency · step)²: half a radian in a step, squared. If it is exceeded, composed steps have no
// advantage (JointConstraints::isCalm).
constexpr double kCalm = 0.25;

// Returns the largest force for which isCalm() is true in a step of length one. The frequency at which a
// force turns a lever is the square root of force / (lever · effective mass).
double calmForceOf(const JointMotion& motion, const JointConstraints::Link& link, const Joint& joint) {
  const double arm_a = length(link.anchor_a), arm_b = length(link.anchor_b);
  const double arm = joint.length > 0 ? joint.length : std::max(arm_a, arm_b);
  if (!(arm > 0)) return kNoLimit;
  const JointMass b = motion.mass[at(link.b)];
  double inverse_mass = b.inverse_mass + b.inverse_inertia * arm_b * arm_b;  // effective one at the anchors
  if (link.a >= 0) {
    const JointMass a = motion.mass[at(link.a)];
    inverse_mass += a.inverse_mass + a.inverse_inertia * arm_a * arm_a;
  }
  return inverse_mass > 0 ? kCalm * arm / inverse_mass : kNoLimit;
}

}  // namespace

JointConstraints::JointConstraints(const JointMotion& motion, std::span<const int> joint_indices,
                                   std::span<const Joint> all_joints) {
  const auto local = [&](int body) {
    const auto found = std::lower_bound(motion.body.begin(), motion.body.end(), body);
    return static_cast<int>(found - motion.body.begin());
  };
  for (const int index : joint_indices) {
    const Joint& joint = all_joints[at(index)];
    Link link = {};
    link.kind = joint.kind;
    link.index = index;
    link.a = joint.kind == JointKind::kMouse ? -1 : local(joint.a);
    link.b = local(joint.b);
    link.anchor_a = joint.anchor_a;
    link.anchor_b = joint.anchor_b;
    link.is_plain = joint.anchor_a == Vec2{} && joint.anchor_b == Vec2{};
    link.holds_angle = joint.kind == JointKind::kWeld || joint.kind == JointKind::kSlider ||
                       joint.kind == JointKind::kAngleLimit;
    link.length = joint.length;
    link.half_inverse_length = joint.length > 0 ? 0.5 / joint.length : 0;
    const bool may_turn = motion.mass[at(link.b)].inverse_inertia > 0 ||
                          (link.a >= 0 && motion.mass[at(link.a)].inverse_inertia > 0);
    link.pulled_inverse_mass = motion.mass[at(link.b)].inverse_mass;
    addRows(link, joint, may_turn);
    link.calm_force = calmForceOf(motion, link, joint);
    links.push_back(link);
  }
  sortByElimination(motion);
  assignRows(all_joints);
  const bool is_rods = std::all_of(links.begin(), links.end(), [](const Link& link) {
    return link.kind == JointKind::kDistance && link.is_plain;
  });
  if (!is_rods) return;
  rods.resize(rows.size());
  for (const Link& link : links) {
    rods[at(link.row[0])] = {link.a, link.b, link.length * link.length, link.half_inverse_length};
  }
}

void JointConstraints::addRows(Link& link, const Joint& joint, bool may_turn) {
  const auto add = [&](int k, Kind its_kind) {
    link.row[k] = static_cast<int>(rows.size());
    rows.push_back({{}, 0, 0, link.a, link.b});
    kind.push_back(its_kind);
    link_of.push_back(static_cast<int>(links.size()));
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

void JointConstraints::sortByElimination(const JointMotion& motion) {
  const std::vector<int> order = eliminationOrder(rows, motion.mass);
  assert(order.size() == rows.size());
  std::vector<int> rank(order.size());
  for (int i = 0; i < static_cast<int>(order.size()); ++i) rank[at(order[at(i)])] = i;
  const auto unsorted_rows = rows;
  const auto unsorted_kinds = kind;
  const auto unsorted_links = link_of;
  for (std::size_t i = 0; i < unsorted_rows.size(); ++i) {
    rows[at(rank[i])] = unsorted_rows[i];
    kind[at(rank[i])] = unsorted_kinds[i];
    link_of[at(rank[i])] = unsorted_links[i];
  }
  for (Link& link : links) {
    for (int& row : link.row) row = row < 0 ? row : rank[at(row)];
  }
}

void JointConstraints::assignRows(std::span<const Joint> all_joints) {
  const std::size_t n = rows.size();
  for (auto* list : {&value, &value_before, &multiplier, &softness, &memory, &diagonal}) list->assign(n, 0);
  low.assign(n, -kNoLimit);
  high.assign(n, kNoLimit);
  side.assign(n, 0);
  is_out.assign(n, 0);
  for (int row = 0; row < static_cast<int>(n); ++row) {
    const Joint& joint = all_joints[at(links[at(link_of[at(row)])].index)];
    const Kind its_kind = kind[at(row)];
    if (its_kind == Kind::kSoft) soft.push_back(row);
    if (its_kind == Kind::kRope || its_kind == Kind::kLimit || its_kind == Kind::kMotor ||
        (joint.kind == JointKind::kMouse && joint.max_force < kNoLimit)) {
      one_sided.push_back(row);
    }
    if (its_kind == Kind::kRope) high[at(row)] = 0;
    if (its_kind == Kind::kRope || its_kind == Kind::kLimit) side[at(row)] = 1;
    is_out[at(row)] = side[at(row)] != 0 ? 1 : 0;
  }
  is_smooth = one_sided.empty() && soft.empty();
  force.assign(links.size(), {});
  torque.assign(links.size(), 0);
}

}  // namespace naiad::physics
