#include "physics/substep/SubstepEnergy.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

namespace {

constexpr double kConsiderable = 0.999;  // smaller factors are counted, unless they only undo rounding
constexpr double kUlps = 6e-8;           // rounding of a float, as a part of its size

}  // namespace

void SubstepEnergy::begin(std::size_t states) {
  m_members.resize(states);
  m_members[0] = {};
  m_velocities.resize(states);
  m_places.resize(states);
  m_groups.resize(states);
  m_marks.assign(states, 0);
}

void SubstepEnergy::set(std::int32_t state, const RigidBody& body, double mass, double inertia,
                        std::int32_t group) {
  Member& m = m_members[at(state)];
  m.mass = mass, m.inertia = inertia;
  m.group = group;
  m_velocities[at(state)] = body.velocity;
  m_places[at(state)] = body.place;
  m_marks[at(group)] |= m_marks[at(state)];
}

void SubstepEnergy::beginBatch(std::span<const std::int32_t> states) {
  m_ids.clear();
  m_roots.clear();
  m_groups[0] = {};
  for (const std::int32_t state : states) {
    if (!isWatched(state)) continue;
    m_ids.push_back(state);
    if (groupOf(state) != state) continue;
    m_groups[at(state)] = {};
    m_roots.push_back(state);
  }
  // Backwards, because the lowest member's velocity is that of the frame.
  for (std::size_t i = m_ids.size(); i-- > 0;) {
    Member& m = m_members[at(m_ids[i])];
    Vec2& velocity = m_velocities[at(m_ids[i])];
    if ((m_marks[at(m.group)] & kHeld) == 0) velocity -= m_velocities[at(m.group)];
    m.twice = Lanes{static_cast<float>(2 * velocity.x), static_cast<float>(2 * velocity.y), 0, 0};
  }
}

// Adds the kinetic energy that the velocity changes of this stage gave to each group.
void SubstepEnergy::sum(std::span<const SubstepState> states) {
  std::int32_t group = 0;
  double twice = 0;
  for (const std::int32_t id : m_ids) {
    const Member& m = m_members[at(id)];
    const Lanes now = speedsOf(states[at(id)]);
    const Lanes changes = (now - m.before) * (m.twice + (now + m.before));
    if (m.group != group) {
      m_groups[at(group)].gain += 0.5 * twice;
      group = m.group;
      twice = 0;
    }
    twice += m.mass * double{changes[0] + changes[1]} + m.inertia * double{changes[2]};
  }
  m_groups[at(group)].gain += 0.5 * twice;
}

// Sets how much each group gained more than it may. True if any did.
bool SubstepEnergy::judge(bool is_bounce) {
  bool is_any = false;
  for (const std::int32_t root : m_roots) {
    Group& group = m_groups[at(root)];
    group.over = (m_marks[at(root)] & kIgnored) != 0 ? 0 : group.gain - (is_bounce ? group.lost : 0);
    is_any = is_any || group.over > 0;
    if (group.gain < 0) group.lost -= group.gain;
    group.gain = 0;
  }
  return is_any;
}

// Finds the motion that the members would have as one rigid body, with the group's momentum and angular
// momentum. A group that something immovable touches has none.
void SubstepEnergy::findRigidMotion(std::span<const SubstepState> states, double time) {
  const auto visitFree = [&](auto visit) {
    for (const std::int32_t id : m_ids) {
      const Member& m = m_members[at(id)];
      Group& group = m_groups[at(m.group)];
      if (group.over <= 0 || (m_marks[at(m.group)] & kHeld) != 0) continue;
      visit(group, m, placeOf(id, states, time), motionOf(id, states));
    }
  };
  for (const std::int32_t root : m_roots) m_groups[at(root)].rigid = {};
  visitFree([](Group& group, const Member& m, Vec2 place, const Motion& motion) {
    group.rigid.mass += m.mass;
    group.rigid.middle += m.mass * place;
    group.rigid.velocity += m.mass * motion.velocity;
  });
  for (const std::int32_t root : m_roots) {
    Rigid& rigid = m_groups[at(root)].rigid;
    if (rigid.mass == 0) continue;
    rigid.middle = rigid.middle / rigid.mass;
    rigid.velocity = rigid.velocity / rigid.mass;
  }
  visitFree([](Group& group, const Member& m, Vec2 place, const Motion& motion) {
    const Vec2 arm = place - group.rigid.middle;
    group.rigid.inertia += m.inertia + m.mass * lengthSquared(arm);
    group.rigid.spin += m.inertia * motion.spin + m.mass * cross(arm, motion.velocity - group.rigid.velocity);
  });
  for (const std::int32_t root : m_roots) {
    Rigid& rigid = m_groups[at(root)].rigid;
    if (rigid.inertia > 0) rigid.spin /= rigid.inertia;
  }
}

// Slows the members of groups that gained too much, relative to their rigid motion.
void SubstepEnergy::slow(std::span<SubstepState> states, double time) {
  findRigidMotion(states, time);
  const auto visit = [&](auto of_member) {
    for (const std::int32_t id : m_ids) {
      const Member& m = m_members[at(id)];
      Group& group = m_groups[at(m.group)];
      if (group.over <= 0) continue;
      Motion off = motionOf(id, states);
      const Vec2 arm = placeOf(id, states, time) - group.rigid.middle;
      off.velocity -= group.rigid.velocity + cross(group.rigid.spin, arm);
      off.spin -= group.rigid.spin;
      of_member(id, m, group, off);
    }
  };
  for (const std::int32_t root : m_roots) m_groups[at(root)].twice = m_groups[at(root)].rounding = 0;
  visit([&](std::int32_t id, const Member& m, Group& group, const Motion& off) {
    group.twice += m.mass * lengthSquared(off.velocity) + m.inertia * off.spin * off.spin;
    const Lanes change = speedsOf(states[at(id)]) - m.before;
    const double gained =
        std::fabs(m.before[0]) + std::fabs(m.before[1]) + std::fabs(change[0]) + std::fabs(change[1]);
    group.rounding += kUlps * m.mass * gained * (gained + std::fabs(m.twice[0]) + std::fabs(m.twice[1]));
  });
  for (const std::int32_t root : m_roots) {
    Group& group = m_groups[at(root)];
    if (group.over <= 0) continue;
    group.factor = group.twice > 0 ? std::sqrt(std::max(1 - 2 * group.over / group.twice, 0.0)) : 1;
    if (group.factor >= kConsiderable) continue;
    // A light body takes energy from a much heavier one, whose velocity is too coarse to show it.
    if (group.over <= group.rounding) {
      group.factor = 1;
    } else {
      ++m_scaled;
    }
  }
  visit([&](std::int32_t id, const Member& m, const Group& group, const Motion& off) {
    SubstepState& s = states[at(id)];
    const double less = 1 - group.factor;
    if (m.mass > 0) {
      s.vx -= static_cast<float>(less * off.velocity.x);
      s.vy -= static_cast<float>(less * off.velocity.y);
    }
    if (m.inertia > 0) s.spin -= static_cast<float>(less * off.spin);
  });
}

void SubstepEnergy::balance(std::span<SubstepState> states, double time, bool is_bounce) {
  sum(states);
  if (judge(is_bounce)) slow(states, time);
}

}  // namespace naiad::physics
