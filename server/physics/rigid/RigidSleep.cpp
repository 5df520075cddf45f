// Finds the groups of connected bodies in a RigidWorld and their linkages, and puts groups at rest to sleep.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

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
  visitLinkages([&](int a, int b) {
    if (isMember(a) && isMember(b)) m_sets.unite(a, b);
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
  for (std::size_t i = 0; i < m_linkages.size(); ++i) {
    const int island = islandOf(m_linkages[i].someBody(), -1);
    if (island < 0) continue;
    if (!m_linkages[i].mayFly()) m_islands[at(island)].may_fly = false;
    if (m_linkages[i].isPure()) m_islands[at(island)].linkage = static_cast<int>(i);
  }
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
    m_extras[at(id)].is_on_joints = island.hard_links > 0 && !island.may_fly;
    m_extras[at(id)].is_in_crowd = island.bodies >= kCrowd || m_extras[at(id)].is_on_joints;
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

// The rigid joints of each group of joined bodies are a linkage. It is alone if the group has no other
// joints, and no shapes and magnets. An existing linkage is kept if it has these joints, because to find
// the order of elimination takes long.
void RigidWorld::findLinkages() {
  if (m_joint_changes == m_joints.changes() && !m_linkages_changed) return;
  m_joint_changes = m_joints.changes();
  m_linkages_changed = false;
  std::vector<RigidJoints::Way> ways;
  std::vector<RigidLinkage> found;
  if (!m_joints.ids().empty()) {
    m_sets.reset(m_bodies.size());
    const auto isMember = [&](int id) { return id >= 0 && isMovable(id); };
    m_joints.visitWorking([&](int a, int b) {
      if (isMember(a) && isMember(b)) m_sets.unite(a, b);
    });
    std::vector<std::uint8_t> is_pure(m_bodies.size(), 1), is_alone(m_bodies.size(), 1);  // by root
    for (int id = 0; id < idLimit(); ++id) {
      const Extra& extra = m_extras[at(id)];
      if (!extra.exists || !isMovable(id)) continue;
      const int root = m_sets.rootOf(id);
      if (extra.is_frozen || m_bodies[at(id)].turn_rate != 0) is_pure[at(root)] = 0;
      if (extra.proxy >= 0) is_alone[at(root)] = 0;
    }
    const auto rootOf = [&](int joint) {
      const Joint& its = m_joints.joint(joint);
      const int member = isMember(its.b) ? its.b : isMember(JointStore::firstOf(its)) ? its.a : -1;
      return its.is_broken || member < 0 ? -1 : m_sets.rootOf(member);
    };
    for (const int id : m_joints.ids()) {
      const int root = rootOf(id);
      if (root >= 0 && !RigidLinkage::canBeAlone(m_joints.joint(id))) is_pure[at(root)] = 0;
    }
    std::vector<std::vector<int>> groups;
    std::vector<int> group_of(m_bodies.size(), -1);
    std::vector<std::uint8_t> has_rigid(m_bodies.size(), 0);  // by root
    for (const int id : m_joints.ids()) {
      const int root = rootOf(id);
      if (root < 0) continue;
      if (group_of[at(root)] < 0) {
        group_of[at(root)] = static_cast<int>(groups.size());
        groups.emplace_back();
      }
      groups[at(group_of[at(root)])].push_back(id);
      if (RigidLinkage::canHave(m_joints.joint(id))) has_rigid[at(root)] = 1;
    }
    for (const std::vector<int>& group : groups) {
      const auto same = std::find_if(m_linkages.begin(), m_linkages.end(), [&](const RigidLinkage& linkage) {
        return linkage.isSame(group, m_joints, m_bodies);
      });
      if (same != m_linkages.end()) {
        found.push_back(std::move(*same));
      } else {
        found.emplace_back(group, m_joints, m_bodies);
      }
      const int root = rootOf(group[0]);
      found.back().setKind(is_pure[at(root)] != 0, is_alone[at(root)] != 0);
      if (!found.back().isAlone() && has_rigid[at(root)] == 0) continue;
      for (const int id : group) {
        if (at(id) >= ways.size()) ways.resize(at(id) + 1, RigidJoints::Way::kHere);
        ways[at(id)] = found.back().isAlone() ? RigidJoints::Way::kLinkage : RigidJoints::Way::kHeld;
      }
    }
  }
  m_linkages = std::move(found);
  m_linkage_of.assign(m_linkages.empty() ? 0 : m_bodies.size(), -1);
  for (std::size_t i = 0; i < m_linkages.size(); ++i) {
    m_linkages[i].visitBodies([&](int body) {
      if (isMovable(body)) m_linkage_of[at(body)] = static_cast<int>(i);
    });
  }
  m_joints.setWays(std::move(ways));
}

void RigidWorld::beginLinkages() {
  for (RigidLinkage& linkage : m_linkages) {
    linkage.setUnbegun();
    if (!linkage.isAlone() && m_extras[at(linkage.someBody())].is_active)
      linkage.begin(m_bodies, m_states, m_joints);
  }
}

// Changes the velocities of groups that are not alone so that their joints fit where the bodies arrive, not
// only where they are. The joints then neither open nor cost energy.
void RigidWorld::aimLinkages(double h) {
  for (RigidLinkage& linkage : m_linkages) {
    if (linkage.isBegun()) linkage.aim(m_states, m_joints, h, m_linkage_counters);
  }
}

// Undoes the errors of joints that are left after the bodies moved, without changing velocities.
void RigidWorld::fitLinkages() {
  for (RigidLinkage& linkage : m_linkages) {
    if (linkage.isBegun()) linkage.fit(m_states);
  }
}

void RigidWorld::dampLinkages() {
  for (RigidLinkage& linkage : m_linkages) {
    if (linkage.isBegun()) linkage.damp(m_states);
  }
}

// Finds which linkages a contact pushes in this half of the sub-step.
void RigidWorld::findPushedLinkages() {
  if (m_linkages.empty()) return;
  m_pushed_linkages.assign(m_linkages.size(), 0);
  for (const ContactConstraint& c : m_constraints) {
    if (!(c.points[0].normal_impulse + c.points[1].normal_impulse > 0)) continue;
    for (const int id : {c.a, c.b}) {
      if (const int linkage = flyingLinkageOf(id); linkage >= 0) m_pushed_linkages[at(linkage)] = 1;
    }
  }
}

// Moves the linkages that nothing has touched in this step.
void RigidWorld::moveLinkages() {
  for (const ContactConstraint& c : m_constraints) {
    if (c.points[0].total + c.points[1].total == 0 && !c.is_deep) continue;
    m_extras[at(c.a)].is_touched = m_extras[at(c.b)].is_touched = true;
  }
  for (RigidLinkage& linkage : m_linkages) {
    if (!m_extras[at(linkage.someBody())].is_active) continue;
    bool is_touched = false;
    linkage.visitLinks([&](int a, int b) {
      is_touched = is_touched || (a >= 0 && isMovable(a) && m_extras[at(a)].is_touched) ||
                   (isMovable(b) && m_extras[at(b)].is_touched);
    });
    if (is_touched) continue;
    if (linkage.isPure()) {
      m_counters.broken += linkage.step(m_bodies, m_states, m_joints, m_linkage_counters);
    } else {
      linkage.limitEnergy(m_bodies, m_states);
    }
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
  visitLinkages([&](int a, int b) {
    lean(a, b);
    lean(b, a);
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
  forgetBeside(id);
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
