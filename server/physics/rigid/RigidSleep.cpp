// Finds the groups of connected bodies in a RigidWorld, and puts groups at rest to sleep.
#include <algorithm>
#include <cmath>

#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

enum : std::uint8_t { kIsHeld = 1, kIsDriven = 2, kIsAdrift = 4 };

constexpr int kFew = 3;            // maximum number of bodies whose impacts within a sub-step may be many
constexpr int kCrowd = 32;         // minimum number of bodies in a large group
constexpr int kMaxElastic = 256;   // maximum number in a large group that moves from impact to impact
constexpr double kCreep = 1e-6;    // cells per tick: a still group that gains more speed does not sleep
constexpr double kMinKick = 1e-5;  // cells per tick: minimum of Island::kick, which is the unit of tolerances

}  // namespace

void RigidWorld::findIslands() {
  m_sets.reset(m_bodies.size());
  const auto isMember = [&](int id) { return m_extras[at(id)].is_active && isMovable(id); };
  for (const ContactConstraint& c : m_constraints) {
    if (c.pair >= 0 && isMember(c.a) && isMember(c.b)) m_sets.unite(c.a, c.b);
  }
  m_joints.visitLinks([&](int a, int b) {
    if (a >= 0 && isMember(a) && isMember(b)) m_sets.unite(a, b);
  });
}

// Returns the index of the island of two bodies; −1 if neither is movable and active.
int RigidWorld::islandOf(int a, int b) {
  for (const int id : {a, b}) {
    if (id >= 0 && m_extras[at(id)].is_active && isMovable(id)) return m_island_of[at(m_sets.rootOf(id))];
  }
  return -1;
}

// Lists bodies, constraints and joints by island; within an island the order does not change.
void RigidWorld::gatherIslands() {
  m_first_late = m_constraints.size();
  m_islands.clear();
  for (const int id : m_active) {
    if (m_sets.rootOf(id) != id) continue;
    m_island_of[at(id)] = static_cast<int>(m_islands.size());
    m_islands.emplace_back();
  }
  const auto ofConstraint = [&](const ContactConstraint& c) { return islandOf(c.a, c.b); };
  for (const int id : m_active) {
    Island& island = m_islands[at(m_island_of[at(m_sets.rootOf(id))])];
    ++island.bodies;
    island.has_fast = island.has_fast || m_extras[at(id)].is_fast;
  }
  for (const ContactConstraint& c : m_constraints) {
    Island& island = m_islands[at(ofConstraint(c))];
    ++island.constraints;
    island.is_elastic = island.is_elastic && c.restitution == 1;
  }
  int counted = 0;
  m_joints.visitLinks([&](int a, int b) {
    Island& island = m_islands[at(islandOf(a, b))];
    ++island.links;
    island.hard_links += m_joints.isSoft(counted++) ? 0 : 1;
  });
  int bodies = 0, constraints = 0, links = 0;
  for (Island& island : m_islands) {
    island.first_body = bodies, bodies += island.bodies;
    island.first_constraint = constraints, constraints += island.constraints;
    island.first_link = links, links += island.links;
    island.budget = kDirectBudget * (island.constraints + island.links) * m_options.substeps;
  }
  for (const int id : m_active) {
    const Island& island = m_islands[at(m_island_of[at(m_sets.rootOf(id))])];
    m_extras[at(id)].is_in_group = island.bodies > kFew;
    m_extras[at(id)].is_in_crowd = island.bodies >= kCrowd || island.hard_links > 0;
    m_extras[at(id)].is_on_joints = island.hard_links > 0;
    m_extras[at(id)].push_sweeps = island.links > 0 ? kPushSweeps : 1;
  }
  for (Island& island : m_islands) island.bodies = island.constraints = island.links = 0;
  m_island_bodies.resize(at(bodies));
  m_island_constraints.resize(at(constraints));
  m_island_links.resize(at(links));
  for (const int id : m_active) {
    Island& island = m_islands[at(m_island_of[at(m_sets.rootOf(id))])];
    m_island_bodies[at(island.first_body + island.bodies++)] = id;
    island.kick = std::max(island.kick, length(m_states[at(id)].kick) + kMinKick);
  }
  for (std::size_t i = 0; i < m_constraints.size(); ++i) {
    Island& island = m_islands[at(ofConstraint(m_constraints[i]))];
    m_island_constraints[at(island.first_constraint + island.constraints++)] = static_cast<int>(i);
  }
  int link = 0;
  m_joints.visitLinks([&](int a, int b) {
    Island& island = m_islands[at(islandOf(a, b))];
    m_island_links[at(island.first_link + island.links++)] = link++;
  });
  for (Island& island : m_islands) {
    const int most = island.is_elastic ? kMaxElastic : kCrowd - 1;
    if (island.has_fast && island.bodies > most && island.hard_links == 0) giveUp(island);
  }
}

// Puts groups to sleep. All bodies of the group must have been still for sleep_delay without becoming faster.
// No kinematic body may drive the group. An immovable body must hold it, or all its speeds must be 0.
void RigidWorld::sleep(double dt) {
  if (!m_options.may_sleep) return;
  for (const int id : m_active) {
    m_island_still[at(id)] = 1e300;
    m_island_gain[at(id)] = {};
    m_island_flags[at(id)] = 0;
    m_island_of[at(id)] = -1;
    m_extras[at(id)].ring = id;
  }
  for (const int id : m_active) {
    Extra& extra = m_extras[at(id)];
    if (extra.is_frozen || !isMovable(id)) continue;
    const RigidBody& body = m_bodies[at(id)];
    const double speed = length(body.velocity) + std::fabs(body.spin) * extra.reach;
    if (extra.still == 0) extra.first_speed = speed;
    extra.still = speed < m_options.sleep_speed ? extra.still + dt : 0;
    const int root = m_sets.rootOf(id);
    Gain& gain = m_island_gain[at(root)];
    gain.before = std::max(gain.before, extra.first_speed);
    gain.now = std::max(gain.now, speed);
    m_island_still[at(root)] = std::min(m_island_still[at(root)], extra.still);
    if (isMoving(id)) m_island_flags[at(root)] |= kIsAdrift;
  }
  const auto lean = [&](int on, int member) {  // an immovable `on` holds or drives the member
    if (isMovable(on) || !m_extras[at(member)].is_active || !isMovable(member)) return;
    m_island_flags[at(m_sets.rootOf(member))] |= isMoving(on) ? kIsDriven : kIsHeld;
  };
  for (const ContactConstraint& c : m_constraints) {
    if (c.points[0].normal_impulse + c.points[1].normal_impulse == 0) continue;
    lean(c.a, c.b);
    lean(c.b, c.a);
  }
  m_joints.visitLinks([&](int a, int b) {
    if (a < 0) {
      m_island_flags[at(m_sets.rootOf(b))] |= kIsHeld;
    } else {
      lean(a, b);
      lean(b, a);
    }
  });
  for (const int id : m_active) {
    Extra& extra = m_extras[at(id)];
    if (extra.is_frozen || !isMovable(id)) continue;
    const int root = m_sets.rootOf(id);
    const std::uint8_t flags = m_island_flags[at(root)];
    if (m_island_still[at(root)] < m_options.sleep_delay || (flags & kIsDriven) != 0) continue;
    if (m_island_gain[at(root)].now > m_island_gain[at(root)].before + kCreep) {
      extra.still = 0;
      continue;
    }
    if ((flags & kIsHeld) == 0 && (flags & kIsAdrift) != 0) continue;
    extra.is_asleep = true;
    int& first = m_island_of[at(root)];
    if (first < 0) first = id;
    if (first != id) std::swap(extra.ring, m_extras[at(first)].ring);
    m_bodies[at(id)].velocity = {};
    m_bodies[at(id)].spin = 0;
    m_states[at(id)] = {};
    m_active_changed = true;
  }
}

void RigidWorld::setSleeping(bool may_sleep) {
  m_options.may_sleep = may_sleep;
  if (may_sleep) return;
  for (int id = 0; id < idLimit(); ++id) wake(id);
}

void RigidWorld::wake(int id) {
  if (!exists(id)) return;
  wakeRing(id);
  forget(id);
}

void RigidWorld::wakeRing(int id) {
  m_extras[at(id)].still = 0;
  if (!m_extras[at(id)].is_asleep) return;
  m_active_changed = true;
  int member = id;
  do {
    Extra& extra = m_extras[at(member)];
    extra.is_asleep = false;
    extra.still = 0;
    member = extra.ring;
  } while (member != id);
}

// Wakes the bodies that touch this one or are joined to it, because they may lean on it.
void RigidWorld::wakeNeighbours(int id) {
  for (const Pair& pair : m_pairs) {
    if (pair.first < 0 || (pair.a != id && pair.b != id)) continue;
    wake(pair.a == id ? pair.b : pair.a);
  }
  m_joints.visitWorking([&](int a, int b) {
    if (a == id) wake(b);
    if (a >= 0 && b == id) wake(a);
  });
}

}  // namespace naiad::physics
