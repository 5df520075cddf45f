#include "physics/substep/SubstepEnergy.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

namespace {

constexpr double kRounding = 1e-4;       // factors nearer to 1 do not change the impulses kept
constexpr double kConsiderable = 0.999;  // smaller factors are counted, unless they only undo rounding
constexpr double kSlightly = 1e-6;  // if bodies are slowed by less, their groups' momentum is still restored
constexpr double kOutside = 1e-5;   // a larger change of momentum, as a part of the impulses, is from outside
constexpr double kUlps = 6e-8;      // rounding of a float, as a part of its size

}  // namespace

void SubstepEnergy::begin(std::size_t states) {
  m_members.resize(states);
  m_members[0] = {};
  m_velocities.resize(states);
  m_places.resize(states);
  m_groups.resize(states);
  m_marks.assign(states, 0);
  m_factors.assign(states, 1);
}

void SubstepEnergy::set(std::int32_t state, const RigidBody& body, double mass, double inertia,
                        std::int32_t group) {
  Member& m = m_members[at(state)];
  m.mass = mass, m.inertia = inertia, m.group = group;
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
  }
  return is_any;
}

// Calls visit() for the members of groups that gained too much, except those that this stage did not push.
template <class Visit>
void SubstepEnergy::visitOver(std::span<const SubstepState> states, Visit visit) {
  for (const std::int32_t id : m_ids) {
    const Member& m = m_members[at(id)];
    Group& group = m_groups[at(m.group)];
    if (!(group.over > 0)) continue;
    const Lanes change = speedsOf(states[at(id)]) - m.before;
    if (change[0] != 0 || change[1] != 0 || change[2] != 0) visit(id, m, group);
  }
}

// Finds the motions that the groups would have as rigid bodies, before and after the stage. Leaves out groups
// with joints and groups that an immovable body pushed.
void SubstepEnergy::findRigidMotions(std::span<const SubstepState> states, double time) {
  for (const std::int32_t root : m_roots) m_groups[at(root)].rigid = {};
  visitOver(states, [&](std::int32_t id, const Member& m, Group& group) {
    Rigid& rigid = group.rigid;
    if ((m_marks[at(m.group)] & kJointed) != 0) return;
    const Lanes change = speedsOf(states[at(id)]) - m.before;
    rigid.pushed += m.mass * double{std::fabs(change[0]) + std::fabs(change[1])};
    rigid.mass += m.mass;
    rigid.middle += m.mass * placeOf(id, states, time);
    rigid.before.velocity += m.mass * motionOf(id, m.before).velocity;
    rigid.after.velocity += m.mass * motionOf(id, speedsOf(states[at(id)])).velocity;
  });
  for (const std::int32_t root : m_roots) {
    Rigid& rigid = m_groups[at(root)].rigid;
    const Vec2 outside = rigid.after.velocity - rigid.before.velocity;
    const bool may_be_held = (m_marks[at(root)] & kHeld) != 0;
    if (may_be_held && length(outside) > kOutside * rigid.pushed) rigid = {};
    if (!(rigid.mass > 0)) continue;
    for (Vec2* const p_sum : {&rigid.middle, &rigid.before.velocity, &rigid.after.velocity})
      *p_sum = *p_sum / rigid.mass;
  }
  visitOver(states, [&](std::int32_t id, const Member& m, Group& group) {
    Rigid& rigid = group.rigid;
    if (rigid.mass == 0) return;
    const Vec2 arm = placeOf(id, states, time) - rigid.middle;
    const auto angular = [&](const Motion& its, Vec2 middle) {
      return m.inertia * its.spin + m.mass * cross(arm, its.velocity - middle);
    };
    rigid.inertia += m.inertia + m.mass * lengthSquared(arm);
    rigid.before.spin += angular(motionOf(id, m.before), rigid.before.velocity);
    rigid.after.spin += angular(motionOf(id, speedsOf(states[at(id)])), rigid.after.velocity);
  });
  for (const std::int32_t root : m_roots) {
    Rigid& rigid = m_groups[at(root)].rigid;
    const double by = rigid.inertia > 0 ? 1 / rigid.inertia : 0;
    rigid.before.spin *= by, rigid.after.spin *= by;
  }
}

// Returns the factor for the velocities relative to the rigid motion; for the velocity changes if joints are
// in the group.
double SubstepEnergy::factorOf(Group& group, bool is_jointed, bool is_bounce) {
  if (is_jointed) {  // with the factor f, the group gains c + b·f + a/2·f²
    const double a = group.twice, c = is_bounce ? -group.lost : -group.given;
    const double b = group.gain - (is_bounce ? 0 : c) - 0.5 * a;
    const double factor = a > 0 ? (std::sqrt(std::max(b * b - 2 * a * c, 0.0)) - b) / a : 0;
    return factor > 0 ? std::min(factor, 1.0) : 0;
  }
  Rigid& rigid = group.rigid;
  // Only if that is not enough, the impulses' error of angular momentum is undone.
  if (2 * group.over <= group.twice) rigid.before.spin = rigid.after.spin;
  const auto twice = [&](const Motion& of) {
    return rigid.mass * lengthSquared(of.velocity) + rigid.inertia * of.spin * of.spin;
  };
  const double less = 2 * group.over + twice(rigid.before) - twice(rigid.after);
  return group.twice > 0 ? std::sqrt(std::clamp(1 - less / group.twice, 0.0, 1.0)) : 1;
}

// Slows the members of groups that gained too much.
void SubstepEnergy::slow(std::span<SubstepState> states, double time, bool is_bounce) {
  findRigidMotions(states, time);
  const auto isJointed = [&](std::int32_t root) { return (m_marks[at(root)] & kJointed) != 0; };
  const auto arm = [&](std::int32_t id, const Group& group) {
    return placeOf(id, states, time) - group.rigid.middle;
  };
  // Returns the velocity change if joints are in the group, else the motion relative to its rigid motion.
  const auto offOf = [&](std::int32_t id, const Member& m, const Group& group) -> Motion {
    const Lanes now = speedsOf(states[at(id)]), change = now - m.before;
    if (isJointed(m.group)) return {{change[0], change[1]}, change[2]};
    const Motion &rigid = group.rigid.after, its = motionOf(id, now);
    return {its.velocity - rigid.velocity - cross(rigid.spin, arm(id, group)), its.spin - rigid.spin};
  };
  for (const std::int32_t root : m_roots) m_groups[at(root)].twice = m_groups[at(root)].rounding = 0;
  visitOver(states, [&](std::int32_t id, const Member& m, Group& group) {
    const Motion off = offOf(id, m, group);
    group.twice += m.mass * lengthSquared(off.velocity) + m.inertia * off.spin * off.spin;
    const Lanes change = speedsOf(states[at(id)]) - m.before;
    const double gained =
        std::fabs(m.before[0]) + std::fabs(m.before[1]) + std::fabs(change[0]) + std::fabs(change[1]);
    group.rounding += kUlps * m.mass * gained * (gained + std::fabs(m.twice[0]) + std::fabs(m.twice[1]));
  });
  for (const std::int32_t root : m_roots) {
    Group& group = m_groups[at(root)];
    if (!(group.over > 0)) continue;
    group.factor = factorOf(group, isJointed(root), is_bounce);
    if (group.factor >= kConsiderable) continue;
    // A light body takes energy from a much heavier one, whose velocity is too coarse to show it.
    const bool is_rounding = group.over <= group.rounding;
    if (is_rounding) group.over = 0;
    if (!is_rounding) ++m_scaled;
  }
  visitOver(states, [&](std::int32_t id, const Member& m, Group& group) {
    const Motion off = offOf(id, m, group);
    const Rigid& rigid = group.rigid;
    const double less = 1 - group.factor, turn = rigid.before.spin - rigid.after.spin;
    const Vec2 velocity =
        rigid.before.velocity - rigid.after.velocity + cross(turn, arm(id, group)) - less * off.velocity;
    SubstepState& s = states[at(id)];
    if (m.mass > 0) s.vx += static_cast<float>(velocity.x), s.vy += static_cast<float>(velocity.y);
    if (m.inertia > 0) s.spin += static_cast<float>(turn - less * off.spin);
    if (!isJointed(m.group) && (less > kSlightly || turn != 0)) {
      m_marks[at(id)] |= kSlowed;
      if (group.first_slowed == 0) group.first_slowed = id;
    }
    if (!isJointed(m.group) || group.factor > 1 - kRounding) return;
    m_factors[at(id)] = static_cast<float>(group.factor);
    m_has_factors = true;
  });
}

bool SubstepEnergy::balance(std::span<SubstepState> states, double time, bool is_bounce) {
  sum(states);
  if (m_has_factors) std::fill(m_factors.begin(), m_factors.end(), 1.0f);
  m_has_factors = false;
  if (judge(is_bounce)) slow(states, time, is_bounce);
  for (const std::int32_t root : m_roots) m_groups[at(root)].gain = m_groups[at(root)].given = 0;
  return m_has_factors;
}

}  // namespace naiad::physics
