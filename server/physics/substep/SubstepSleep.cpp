// Which bodies of a SubstepWorld form a group, and which groups may sleep.
#include <algorithm>
#include <cmath>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

constexpr double kCreep = 1e-6;  // cells per tick that a group at rest may gain while it is watched
// Cells per tick: what floats at rest and touching in free space is left with by rounding. What drifts does
// so faster, and never sleeps.
constexpr double kAdrift = 1e-12;

bool isMoving(const SubstepBody& b) {
  return b.body.velocity != Vec2{} || b.body.spin != 0;
}

}  // namespace

void SubstepWorld::unite(const SubstepBody& a, const SubstepBody& b) {
  if (isMovable(a) && isMovable(b)) {
    if (a.state == 0 || b.state == 0) return;
    m_sets.unite(a.state, b.state);
  }
}

// Groups are what joints and contacts that push connect; what cannot move holds them, or drives them if it
// goes its own way.
void SubstepWorld::findGroups() {
  m_sets.reset(m_states.size());
  const auto forEachHold = [&](auto visit) {
    for (const Contact& c : m_contacts) {
      if (m_pairs[at(c.pair)].is_pushing) visit(m_bodies[at(c.a)], m_bodies[at(c.b)]);
    }
    m_joints.visitLinks([&](int a, int b) {
      if (a >= 0) visit(m_bodies[at(a)], m_bodies[at(b)]);
    });
  };
  forEachHold([&](const SubstepBody& a, const SubstepBody& b) { unite(a, b); });
  m_groups.assign(m_states.size(), {});
  const auto lean = [&](const SubstepBody& on, const SubstepBody& member) {
    if (isMovable(on) || member.state == 0 || !isMovable(member)) return;
    Group& group = groupOf(member);
    group.is_held = true;
    group.is_driven = group.is_driven || isMoving(on);
  };
  forEachHold([&](const SubstepBody& a, const SubstepBody& b) {
    lean(a, b);
    lean(b, a);
  });
  m_joints.visitLinks([&](int a, int b) {
    if (a < 0 && m_bodies[at(b)].state > 0) groupOf(m_bodies[at(b)]).is_held = true;
  });
}

// A group sleeps when all of it has been still for a while and is not speeding up, and something that cannot
// move holds it, or nothing pulls at it at all.
void SubstepWorld::sleep() {
  if (!m_options.may_sleep) return;
  for (const std::int32_t id : m_active) {
    SubstepBody& b = m_bodies[at(id)];
    if (b.is_frozen || !isMovable(b)) continue;
    const double speed = length(b.body.velocity) + std::fabs(b.body.spin) * b.reach;
    if (b.still == 0) b.first_speed = speed;
    b.still = speed < m_options.sleep_speed ? b.still + m_dt : 0;
    Group& group = groupOf(b);
    group.still = std::min(group.still, b.still);
    group.speed_before = std::max(group.speed_before, b.first_speed);
    group.speed = std::max(group.speed, speed);
    group.is_adrift = group.is_adrift || speed > kAdrift;
  }
  for (const std::int32_t id : m_active) {
    SubstepBody& b = m_bodies[at(id)];
    if (b.is_frozen || !isMovable(b)) continue;
    Group& group = groupOf(b);
    if (group.still < m_options.sleep_delay || group.is_driven || (!group.is_held && group.is_adrift))
      continue;
    if (group.speed > group.speed_before + kCreep) {
      b.still = 0;
      continue;
    }
    b.is_asleep = true;
    b.body.velocity = b.drift = {};
    b.body.spin = b.roll = 0;
    b.is_busy = true;
    b.ring = id;
    if (group.first >= 0) {
      std::swap(b.ring, m_bodies[at(group.first)].ring);
    } else {
      group.first = id;
    }
    m_active_changed = true;
  }
}

}  // namespace naiad::physics
