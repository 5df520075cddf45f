#include "physics/substep/SubstepEnergy.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

namespace {

constexpr float kRounding = 1e-4f;       // factors nearer to 1 do not change the impulses kept
constexpr float kConsiderable = 0.999f;  // smaller factors are counted
constexpr double kUlps = 6e-8;           // rounding of a float, as a part of its size

}  // namespace

void SubstepEnergy::begin(std::size_t states) {
  m_members.resize(states);
  m_members[0] = {};
  m_velocities.resize(states);
  m_groups.resize(states);
  m_marks.assign(states, 0);
  if (m_has_factors) m_factors.clear();
  m_factors.resize(states, 1);
  m_has_factors = false;
}

void SubstepEnergy::set(std::int32_t state, Vec2 velocity, double mass, double inertia, std::int32_t group) {
  Member& m = m_members[at(state)];
  m.mass = mass, m.inertia = inertia;
  m.group = group;
  m_velocities[at(state)] = velocity;
  m_marks[at(group)] |= m_marks[at(state)];
}

void SubstepEnergy::chooseFrames() {
  // Backwards, because the lowest member's velocity is that of the frame.
  for (std::size_t i = m_members.size(); i-- > 1;) {
    const std::size_t group = at(m_members[i].group);
    Vec2& velocity = m_velocities[i];
    if ((m_marks[group] & kHeld) == 0) velocity -= m_velocities[group];
    m_members[i].twice = Lanes{static_cast<float>(2 * velocity.x), static_cast<float>(2 * velocity.y), 0, 0};
  }
}

void SubstepEnergy::beginBatch(std::span<const std::int32_t> states) {
  m_roots.clear();
  m_groups[0] = {};
  for (const std::int32_t state : states) {
    if (groupOf(state) != state) continue;
    m_groups[at(state)] = {};
    m_roots.push_back(state);
  }
}

// Adds the kinetic energy that the velocity changes of this stage gave to each group.
void SubstepEnergy::sum(std::span<const std::int32_t> ids, std::span<const SubstepState> states) {
  std::int32_t group = 0;
  double twice = 0;
  for (const std::int32_t id : ids) {
    const Member& m = m_members[at(id)];
    Lanes now;
    __builtin_memcpy(&now, &states[at(id)].vx, sizeof now);
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

// True if any group gained more energy than it may.
bool SubstepEnergy::judge(bool is_bounce) {
  bool is_any = false;
  for (const std::int32_t root : m_roots) {
    Group& group = m_groups[at(root)];
    group.is_over = (m_marks[at(root)] & kIgnored) == 0 && group.gain > (is_bounce ? group.lost : 0);
    is_any = is_any || group.is_over;
    if (group.gain < 0) group.lost -= group.gain;
  }
  return is_any;
}

void SubstepEnergy::scale(std::span<const std::int32_t> ids, std::span<SubstepState> states, bool is_bounce) {
  const auto changeOf = [&](std::int32_t id) {
    Lanes now;
    __builtin_memcpy(&now, &states[at(id)].vx, sizeof now);
    return now - m_members[at(id)].before;
  };
  for (const std::int32_t root : m_roots) m_groups[at(root)].square = m_groups[at(root)].rounding = 0;
  for (const std::int32_t id : ids) {
    const Member& m = m_members[at(id)];
    Group& group = m_groups[at(m.group)];
    const Lanes change = changeOf(id);
    const double x = change[0], y = change[1], spin = change[2];
    group.square += m.mass * (x * x + y * y) + m.inertia * spin * spin;
    const Lanes before = m_members[at(id)].before, twice = m_members[at(id)].twice;
    const double gained =
        std::fabs(before[0]) + std::fabs(before[1]) + std::fabs(change[0]) + std::fabs(change[1]);
    group.rounding += kUlps * m.mass * gained * (gained + std::fabs(twice[0]) + std::fabs(twice[1]));
  }
  for (const std::int32_t root : m_roots) {
    Group& group = m_groups[at(root)];
    if (!group.is_over) continue;
    // With the factor f, the group gains c + b·f + a/2·f².
    const double a = group.square, c = is_bounce ? -group.lost : -group.given;
    const double b = group.gain - (is_bounce ? 0 : c) - 0.5 * a;
    const double factor = a > 0 ? (std::sqrt(std::max(b * b - 2 * a * c, 0.0)) - b) / a : 0;
    group.factor = factor > 0 ? static_cast<float>(std::min(factor, 1.0)) : 0;
    // A light body takes energy from a much heavier one, whose velocity is too coarse to show it.
    const bool is_rounding = group.gain - (is_bounce ? group.lost : 0) <= group.rounding;
    if (group.factor >= kConsiderable) continue;
    if (is_rounding) group.factor = 1;
    if (!is_rounding) ++m_scaled;
  }
  for (const std::int32_t id : ids) {
    const Group& group = m_groups[at(groupOf(id))];
    if (!group.is_over) continue;
    const Lanes now = m_members[at(id)].before + lanesOf(group.factor) * changeOf(id);
    __builtin_memcpy(&states[at(id)].vx, &now, sizeof now);
    if (group.factor > 1 - kRounding) continue;
    m_factors[at(id)] = group.factor;
    m_has_factors = true;
  }
}

bool SubstepEnergy::balance(std::span<const std::int32_t> ids, std::span<SubstepState> states,
                            bool is_bounce) {
  sum(ids, states);
  if (m_has_factors) std::fill(m_factors.begin(), m_factors.end(), 1.0f);
  m_has_factors = false;
  if (judge(is_bounce)) scale(ids, states, is_bounce);
  for (const std::int32_t root : m_roots) m_groups[at(root)].gain = m_groups[at(root)].given = 0;
  return m_has_factors;
}

}  // namespace naiad::physics
