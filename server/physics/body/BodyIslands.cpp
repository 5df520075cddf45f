#include "physics/body/BodyIslands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/body/BodyObstacles.h"
#include "physics/geometry/Index.h"

namespace df {

namespace {

using naiad::physics::at;
using naiad::physics::BodyJoints;
using naiad::physics::BodyPlan;
using naiad::physics::BodyTable;
using naiad::physics::BodyWay;
using naiad::physics::Vec2;

}  // namespace

int BodyIslands::rootOf(int plan) {
  while (m_parent[at(plan)] != plan) plan = m_parent[at(plan)] = m_parent[at(m_parent[at(plan)])];
  return plan;
}

void BodyIslands::unite(int a, int b) {
  a = rootOf(a);
  b = rootOf(b);
  m_parent[at(std::max(a, b))] = std::min(a, b);
}

// Pairs of HARD ones whose reaches overlap, in no particular order: nothing depends on it.
void BodyIslands::gather(const std::vector<BodyPlan>& plans) {
  m_boxes.clear();
  m_ids.clear();
  m_pairs.clear();
  naiad::physics::Place origin;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (!plans[i].is_hard || plans[i].p_failure != nullptr) continue;
    if (m_ids.empty()) origin = plans[i].start;
    const Vec2 centre = plans[i].start - origin;
    m_ids.push_back(static_cast<int>(i));
    m_boxes.push_back({centre - plans[i].reach, centre + plans[i].reach});
  }
  m_tree.update(m_boxes, m_ids, static_cast<int>(plans.size()));
  m_tree.queryPairs([&](int i, int j) { m_pairs.emplace_back(i, j); });
}

void BodyIslands::join(const BodyTable& table, const std::vector<BodyPlan>& plans) {
  m_plan_of.clear();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (plans[i].index >= m_plan_of.size()) m_plan_of.resize(plans[i].index + 1, -1);
    m_plan_of[plans[i].index] = static_cast<int>(i);
  }
  const auto planOf = [&](int row) {
    return row >= 0 && row < static_cast<int>(m_plan_of.size()) ? m_plan_of[at(row)] : -1;
  };
  for (const naiad::physics::JointEntry& entry : table.joints.entries()) {
    if (!entry.used) continue;
    const int a = planOf(entry.joint.a), b = planOf(entry.joint.b);
    if (a < 0 || b < 0 || plans[at(a)].is_kinematic || plans[at(b)].is_kinematic) continue;
    unite(a, b);
  }
}

bool BodyIslands::areJoined(const BodyTable& table, int row_a, int row_b) const {
  const auto& entries = table.joints.entries();
  return std::any_of(entries.begin(), entries.end(), [&](const naiad::physics::JointEntry& entry) {
    const int a = entry.joint.a, b = entry.joint.b;
    return entry.used && ((a == row_a && b == row_b) || (a == row_b && b == row_a));
  });
}

// Are there obstacles near those that are not for an ImpactWorld?
void BodyIslands::lookAround(const WorldStore& store, const BodyTable& table,
                             const std::vector<BodyPlan>& plans) {
  for (const int i : m_ids) {
    Group& group = m_groups[at(rootOf(i))];
    const BodyPlan& plan = plans[at(i)];
    if (!group.is_rigid || group.has_obstacle || plan.is_kinematic) continue;
    if (group.may_touch && !group.is_elastic) continue;
    m_found.clear();
    store.touching(regionOf(table.metric, plan.start, plan.reach), plan.key.slot, m_found);
    group.has_obstacle = std::any_of(m_found.begin(), m_found.end(),
                                     [&store](ObjectKey key) { return BodyObstacles::isOne(store, key); });
    group.may_touch = group.may_touch || group.has_obstacle;
  }
}

void BodyIslands::connect(const BodyTable& table, const std::vector<BodyPlan>& plans) {
  m_parent.resize(plans.size());
  for (std::size_t i = 0; i < plans.size(); ++i) m_parent[i] = static_cast<int>(i);
  gather(plans);
  join(table, plans);
  for (const auto& [i, j] : m_pairs) {
    if (!plans[at(i)].is_kinematic && !plans[at(j)].is_kinematic) unite(i, j);
  }
}

// What kind of group is it?
void BodyIslands::judge(const BodyTable& table, const naiad::physics::BodyLinks& links,
                        const naiad::physics::BodyContacts& contacts, const std::vector<BodyPlan>& plans) {
  m_groups.assign(plans.size(), {});
  for (const int i : m_ids) {
    const BodyPlan& plan = plans[at(i)];
    if (plan.is_kinematic) continue;
    Group& group = m_groups[at(rootOf(i))];
    const bool stays = static_cast<BodyWay>(table.row(plan.index).last_way) == BodyWay::kRigid &&
                       contacts.isTouching(plan.key);
    const bool is_joined = links.isJoined(plan.index);
    group.is_rigid = group.is_rigid || !plan.is_simple || stays || is_joined;
    group.is_elastic = group.is_elastic && plan.radius > 0 && !stays && (is_joined || !plan.is_bent);
    group.fastest = std::max(group.fastest, length(plan.start_velocity) + length(plan.push));
  }
  m_touchable.clear();
  const bool has_joints = table.joints.count() > 0;
  for (const auto& [i, j] : m_pairs) {
    const BodyPlan &a = plans[at(i)], &b = plans[at(j)];
    if (a.is_kinematic && b.is_kinematic) continue;
    if (has_joints && areJoined(table, static_cast<int>(a.index), static_cast<int>(b.index))) continue;
    m_touchable.emplace_back(i, j);
    Group& group = m_groups[at(rootOf(a.is_kinematic ? j : i))];
    group.may_touch = true;
    const BodyPlan& other = a.is_kinematic ? a : b;
    if (other.is_kinematic && !other.is_simple) group.is_rigid = true;
    const double bounce = std::max(table.row(a.index).restitution, table.row(b.index).restitution);
    if (other.is_kinematic || bounce == 0) group.is_elastic = false;
  }
}

// Who is struck may get as far as the fastest one would, and farther if he is light. Does anybody?
bool BodyIslands::widen(std::vector<BodyPlan>& plans) {
  constexpr double kRoom = 0.2, kLight = 2;
  bool is_wider = false;
  for (const int i : m_ids) {
    const Group& group = m_groups[at(rootOf(i))];
    if (!group.is_rigid || !group.may_touch || !group.is_elastic || group.fastest <= kRoom) continue;
    const double more = kLight * group.fastest;
    plans[at(i)].reach += Vec2{more, more};
    is_wider = true;
  }
  return is_wider;
}

void BodyIslands::meet(std::vector<BodyPlan>& plans) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (plans[i].way == BodyWay::kStruck) plans[i].group = rootOf(static_cast<int>(i));
  }
  for (const auto& [i, j] : m_touchable) {
    if (plans[at(i)].way == BodyWay::kStruck) m_meetings.push_back({plans[at(i)].group, i, j});
  }
  std::sort(m_meetings.begin(), m_meetings.end());
}

void BodyIslands::choose(const WorldStore& store, const BodyTable& table,
                         const naiad::physics::BodyLinks& links, const naiad::physics::BodyContacts& contacts,
                         std::vector<BodyPlan>& plans) {
  m_meetings.clear();
  connect(table, plans);
  judge(table, links, contacts, plans);
  if (widen(plans)) {
    connect(table, plans);
    judge(table, links, contacts, plans);
  }
  lookAround(store, table, plans);
  bool is_struck = false;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    BodyPlan& plan = plans[i];
    const Group& group = m_groups[at(rootOf(static_cast<int>(i)))];
    if (plan.p_failure != nullptr || plan.is_kinematic) continue;
    if (group.is_rigid && group.may_touch) {
      const bool is_elastic = group.is_elastic && !group.has_obstacle;
      plan.way = is_elastic ? BodyWay::kStruck : BodyWay::kRigid;
      is_struck = is_struck || is_elastic;
    } else if (!links.isJoined(plan.index)) {
      plan.way = plan.is_hard && plan.is_simple ? BodyWay::kImpact : BodyWay::kAlone;
    }
  }
  if (is_struck) meet(plans);
  for (const auto& [i, j] : m_pairs) {
    BodyPlan &a = plans[at(i)], &b = plans[at(j)];
    if (a.is_kinematic && b.way == BodyWay::kRigid) a.is_near_rigid = true;
    if (b.is_kinematic && a.way == BodyWay::kRigid) b.is_near_rigid = true;
  }
}

}  // namespace df
