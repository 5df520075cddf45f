// Solves a group of bodies connected by contacts and joints: directly, or by sweeps if that costs too much.
#include <algorithm>
#include <cmath>

#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

// Maximum rounds of factorisation and solution of a group; if they are not enough, it is solved by sweeps. A
// leaning stack of 40 bodies needs up to 30 rounds, but each of them is cheap.
constexpr int kRounds = 16;
constexpr int kTallRounds = 32;
constexpr int kTall = 24;         // minimum number of bodies in a tall group: a stack or chain
constexpr double kSlender = 100;  // maximum multiplications per body for a factorisation of a tall group
// Maximum cost of a direct solution in multiplications (10⁶ take about 0.3 ms): a constant, and an amount per
// contact and joint. It is not tried if all rounds might cost more. A new heap needs most of the rounds, so
// that fewer rounds would be wasted.
constexpr double kAttemptStart = 1e6;
constexpr double kAttempt = 22'000;
constexpr double kSmallCost = 1e4;  // in multiplications per round; cheaper solutions that fail are retried
// Speeds in units of Island::kick, the speed that acceleration adds in half a sub-step:
constexpr double kSpeedError = 1e-6;       // sweeps of a single contact end when the change is smaller
constexpr double kRest = 4;                // with a larger speed error, a contact is a blow, not at rest
constexpr double kDirectTolerance = 1e-6;  // remaining error of a direct solution; lets a stack sag
// Numbers of Gauss–Seidel sweeps for groups that are not solved directly:
constexpr int kSingleSweeps = 16;  // maximum for a single contact
constexpr int kJointSweeps = 8;    // for groups with joints

constexpr double kUnequalMassRatio = 1.3;  // if the mass ratio is larger, sweeps crush or throw light bodies

bool areUnequal(std::span<const int> bodies, std::span<const RigidState> states) {
  double least = 0, most = 0;
  for (const int id : bodies) {
    const double inverse = states[at(id)].inverse_mass;
    if (!(inverse > 0)) continue;
    least = least > 0 ? std::min(least, inverse) : inverse;
    most = std::max(most, inverse);
  }
  return most > kUnequalMassRatio * least;
}

// Removes the warm start of a group if it adds energy, or makes a body more than twice as fast as any body
// was. A direct solution corrects the impulses of the last sub-step, but sweeps do not: after a blow they may
// throw light bodies. The sweeps then start without impulses and add no energy.
void dropHarmfulWarmStart(std::span<const int> bodies, std::span<const int> constraints,
                          std::span<ContactConstraint> all, std::span<RigidState> states) {
  const auto give = [&](RigidState& s, Vec2 impulse, double turning) {
    s.push += s.inverse_mass * impulse;
    s.push_spin += s.inverse_inertia * turning;
  };
  for (const int i : constraints) {
    const ContactConstraint& c = all[at(i)];
    for (std::int32_t k = 0; k < c.count; ++k) {
      const ContactPoint& p = c.points[at(k)];
      const Vec2 impulse = p.normal_warm * c.normal + p.friction_warm * perpendicular(c.normal);
      give(states[at(c.a)], -impulse, -(p.normal_a * p.normal_warm + p.tangent_a * p.friction_warm));
      give(states[at(c.b)], impulse, p.normal_b * p.normal_warm + p.tangent_b * p.friction_warm);
    }
  }
  constexpr double kFaster = 4;  // square of the ratio of speeds, two
  double gain = 0, before = 0, after = 0;
  for (const int id : bodies) {
    const RigidState& s = states[at(id)];
    const Vec2 velocity = s.velocity - s.push;
    const double spin = s.spin - s.push_spin;
    if (!(s.inverse_mass > 0)) continue;
    const double inertia = s.inverse_inertia > 0 ? s.inverse_mass / s.inverse_inertia : 0;
    const double old_square = lengthSquared(velocity) + inertia * spin * spin;
    const double square = lengthSquared(s.velocity) + inertia * s.spin * s.spin;
    gain += (square - old_square) / s.inverse_mass;
    before = std::max(before, old_square);
    after = std::max(after, square);
  }
  const bool is_harmful = gain > 0 || after > kFaster * before;
  for (const int id : bodies) {
    RigidState& s = states[at(id)];
    if (is_harmful) s.velocity -= s.push, s.spin -= s.push_spin;
    s.push = {};
    s.push_spin = 0;
  }
  if (!is_harmful) return;
  for (const int i : constraints) {
    for (ContactPoint& p : all[at(i)].points) {
      p.total += p.normal_impulse - p.normal_warm;
      p.normal_impulse = p.friction_impulse = p.normal_warm = p.friction_warm = 0;
    }
  }
}

}  // namespace

void RigidWorld::solveIsland(Island& island, bool is_second) {
  if (island.constraints + island.links == 0) return;
  const bool is_single = island.constraints == 1 && island.links == 0;
  if (island.budget > 0 && !is_single && solveAtOnce(island, is_second)) return;
  if (island.constraints == 1 && island.links == 0) {  // sweeps of a single contact converge quickly
    ContactConstraint& c = m_constraints[at(m_island_constraints[at(island.first_constraint)])];
    for (int i = 0; i < kSingleSweeps && solveContact(c, m_states, is_second) > kSpeedError * island.kick;
         ++i) {
    }
    return;
  }
  const std::span<const int> bodies =
      std::span(m_island_bodies).subspan(at(island.first_body), at(island.bodies));
  const std::span<const int> constraints =
      std::span(m_island_constraints).subspan(at(island.first_constraint), at(island.constraints));
  const bool is_unequal = areUnequal(bodies, m_states);
  if (is_unequal) dropHarmfulWarmStart(bodies, constraints, m_constraints, m_states);
  for (int sweep = 0; sweep < (island.links > 0 ? kJointSweeps : 1); ++sweep) {
    for (int i = 0; i < island.links; ++i) {
      m_joints.solve(m_island_links[at(island.first_link + i)], m_states, is_second);
    }
    for (int i = 0; i < island.constraints; ++i) {
      const int k = is_second ? island.constraints - 1 - i : i;
      solveContact(m_constraints[at(m_island_constraints[at(island.first_constraint + k)])], m_states,
                   is_second);
    }
  }
  if (!is_unequal) return;
  for (const int i : constraints) {  // contacts with immovable bodies are solved last
    ContactConstraint& c = m_constraints[at(i)];
    if (!isMovable(c.a) || !isMovable(c.b)) solveContact(c, m_states, is_second);
  }
}

void RigidWorld::giveUp(Island& island) {
  island.budget = 0;
  for (int i = 0; i < island.bodies; ++i)
    m_extras[at(m_island_bodies[at(island.first_body + i)])].is_given_up = true;
}

bool RigidWorld::solveAtOnce(Island& island, bool is_second) {
  m_direct.begin(std::span(m_island_bodies).subspan(at(island.first_body), at(island.bodies)), m_states);
  std::vector<DirectRow>& rows = m_direct.rows();
  const auto speedOfImmovable = [&](const DirectRow& row, int a, int b) {
    double speed = 0;
    if (row.a < 0 && a >= 0) speed += row.ja * m_states[at(a)].spin - dot(row.n, m_states[at(a)].velocity);
    if (row.b < 0) speed += row.jb * m_states[at(b)].spin + dot(row.n, m_states[at(b)].velocity);
    return speed;
  };
  for (int i = 0; i < island.links; ++i) {
    for (const RigidRow& row : m_joints.rowsOfLink(m_island_links[at(island.first_link + i)])) {
      const RigidRowHalf& half = row.half[is_second];
      if (half.mass == 0) continue;
      DirectRow direct;
      direct.a = m_direct.localOf(row.a), direct.b = m_direct.localOf(row.b);
      direct.n = row.n;
      direct.ja = row.ja, direct.jb = row.jb;
      direct.target = half.target - speedOfImmovable(direct, row.a, row.b);
      direct.softness = half.softness;
      direct.before = row.before;
      direct.low = half.low, direct.high = half.high;
      direct.impulse = row.impulse;
      rows.push_back(direct);
    }
  }
  const auto constraintAt = [&](int i) -> ContactConstraint& {
    return m_constraints[at(m_island_constraints[at(island.first_constraint + i)])];
  };
  const auto isNew = [&] {  // true if there are no known impulses
    for (int i = 0; i < island.constraints; ++i) {
      const ContactConstraint& c = constraintAt(i);
      if (c.points[0].normal_warm != 0 || c.points[1].normal_warm != 0) return false;
    }
    return island.links == 0;
  };
  // For a group at rest, the first half's impulses are the guess for the second: they must be equal.
  const bool is_guessed = is_second && island.rests_anew;
  for (int i = 0; i < island.constraints; ++i) {
    const ContactConstraint& c = constraintAt(i);
    DirectRow direct;
    direct.a = m_direct.localOf(c.a), direct.b = m_direct.localOf(c.b);
    for (std::int32_t k = 0; k < c.count; ++k) {
      const ContactPoint& p = c.points[at(k)];
      DirectRow normal = direct;
      normal.n = c.normal;
      normal.ja = -p.normal_a, normal.jb = p.normal_b;
      normal.target = (is_second ? p.after : p.target) - speedOfImmovable(normal, c.a, c.b);
      normal.impulse = p.normal_impulse;
      normal.expected = is_guessed ? p.normal_impulse : 0;
      rows.push_back(normal);
      if (c.friction == 0) continue;
      DirectRow friction = direct;
      friction.n = perpendicular(c.normal);
      friction.ja = -p.tangent_a, friction.jb = p.tangent_b;
      friction.target = -speedOfImmovable(friction, c.a, c.b);
      friction.impulse = p.friction_impulse;
      friction.expected = is_guessed ? p.friction_impulse : 0;
      friction.normal = static_cast<std::int32_t>(rows.size()) - 1;
      friction.friction = c.friction;
      rows.push_back(friction);
    }
  }
  const double tolerance = kDirectTolerance * island.kick;
  const double worst = m_direct.worstError();
  if (!is_second) island.rests_anew = worst <= kRest * island.kick && isNew();
  if (worst <= tolerance) return true;
  const double price = m_direct.order();
  const double cost = price + 100.0 * static_cast<double>(rows.size());
  const double parts = island.constraints + island.links;
  const bool is_tall = island.bodies >= kTall && price <= kSlender * island.bodies;
  const int most_rounds = is_tall ? kTallRounds : kRounds;
  if (most_rounds * cost > kAttemptStart + kAttempt * parts) {
    ++m_counters.direct_refusals;
    giveUp(island);
  }
  if (cost > island.budget) return false;
  ++m_counters.direct_solves;
  int rounds = 0;
  const bool is_found = m_direct.solve(m_states, tolerance, most_rounds, rounds);
  m_counters.direct_rounds += rounds;
  island.budget -= rounds * cost;
  if (!is_found) {
    ++m_counters.direct_failures;
    if (cost > kSmallCost) giveUp(island);
    return false;
  }
  std::size_t next = 0;
  for (int i = 0; i < island.links; ++i) {
    for (RigidRow& row : m_joints.rowsOfLink(m_island_links[at(island.first_link + i)])) {
      if (row.half[is_second].mass != 0) row.impulse = rows[next++].impulse;
    }
  }
  for (int i = 0; i < island.constraints; ++i) {
    ContactConstraint& c = constraintAt(i);
    for (std::int32_t k = 0; k < c.count; ++k) {
      c.points[at(k)].normal_impulse = rows[next++].impulse;
      if (c.friction > 0) c.points[at(k)].friction_impulse = rows[next++].impulse;
    }
  }
  return true;
}

}  // namespace naiad::physics
