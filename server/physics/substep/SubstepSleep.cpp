// Finds the groups of connected bodies in a SubstepWorld, and puts groups at rest to sleep.
#include <algorithm>
#include <cmath>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

constexpr double kCreep = 1e-6;  // cells per tick: a still group that gains more speed does not sleep
// Cells per tick: maximum speed that rounding leaves to touching bodies at rest in free space. Bodies that
// are faster drift and never sleep.
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

// Finds the groups of bodies that are connected by joints and pushing contacts. An immovable body holds the
// groups to which it is connected, and drives them if it moves (kinematic).
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
  // Momentum has moved between the bodies that were slowed, even if they do not push each other.
  for (const std::int32_t id : m_active) {
    const std::int32_t state = m_bodies[at(id)].state;
    if (m_energy.isSlowed(state)) m_sets.unite(state, m_energy.firstSlowedOf(state));
  }
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

// Puts groups to sleep. All bodies of the group must have been still for sleep_delay without becoming faster.
// No kinematic body may drive the group. An immovable body must hold it, or it must not drift (kAdrift).
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
