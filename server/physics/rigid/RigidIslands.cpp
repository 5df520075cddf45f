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
constexpr int kSweeps = 8;         // for groups with joints or few bodies
constexpr int kMany = 32;          // minimum number of bodies of a group without joints that is swept once

constexpr double kEnergyRounding = 1e-12;  // rounding error of a group's energy
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

}  // namespace

void RigidWorld::solveIsland(Island& island, bool is_second) {
  if (island.constraints + island.links == 0) return;
  const bool is_single = island.constraints == 1 && island.links == 0;
  if (island.budget > 0 && !is_single && solveAtOnce(island, is_second)) return;
  if (island.constraints == 1 && island.links == 0) {  // sweeps of a single contact converge quickly
    ContactConstraint& c = m_constraints[at(constraintsOf(island)[0])];
    for (int i = 0; i < kSingleSweeps && solveContact(c, m_states, is_second) > kSpeedError * island.kick;
         ++i) {
    }
    return;
  }
  if (areUnequal(bodiesOf(island), m_states)) {
    const double part = partOfGuess(island, is_second);
    if (part < 1) restart(island, is_second, part);
  }
  sweepIsland(island, is_second, island.links > 0 || island.bodies < kMany ? kSweeps : 1);
}

void RigidWorld::sweepIsland(const Island& island, bool is_second, int sweeps) {
  const std::span<const int> constraints = constraintsOf(island);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const int link : linksOf(island)) m_joints.solve(link, m_states, is_second);
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      const std::size_t k = is_second ? constraints.size() - 1 - i : i;
      solveContact(m_constraints[at(constraints[k])], m_states, is_second);
    }
  }
  if (!areUnequal(bodiesOf(island), m_states)) return;
  for (const int i : constraints) {  // contacts with immovable bodies are solved last
    ContactConstraint& c = m_constraints[at(i)];
    if (!isMovable(c.a) || !isMovable(c.b)) solveContact(c, m_states, is_second);
  }
}

void RigidWorld::addWork(const RigidState& s, Work& work) {
  const Vec2 change = s.velocity - s.velocity_before;
  const double turn = s.spin - s.spin_before;
  work.along += s.mass * dot(s.velocity_before, change) + s.inertia * s.spin_before * turn;
  work.square += s.mass * lengthSquared(change) + s.inertia * turn * turn;
  work.before += s.mass * lengthSquared(s.velocity_before) + s.inertia * s.spin_before * s.spin_before;
  work.pull += s.mass * dot(s.kick, change) + s.inertia * s.spin_kick * turn;
}

RigidWorld::Work RigidWorld::workOf(const Island& island) const {
  Work work;
  for (const int id : bodiesOf(island)) addWork(m_states[at(id)], work);
  return work;
}

// Returns the energy that drivers may add to the group by the impulses of this half: moving surfaces, motors
// and springs.
double RigidWorld::inputOf(const Island& island, bool is_second) {
  double input = 0;
  for (const int i : constraintsOf(island)) {
    input += physics::inputOf(m_constraints[at(i)], m_states);
  }
  for (const int link : linksOf(island)) input += m_joints.inputOf(link, m_states, is_second);
  return input;
}

// Applies the impulses known from the last sub-step, multiplied by `part`, and no others.
void RigidWorld::restart(const Island& island, bool is_second, double part) {
  for (const int id : bodiesOf(island)) {
    RigidState& s = m_states[at(id)];
    s.velocity = s.velocity_before;
    s.spin = s.spin_before;
  }
  for (const int i : constraintsOf(island)) {
    physics::restart(m_constraints[at(i)], m_states, part);
  }
  for (const int link : linksOf(island)) m_joints.restart(link, m_states, is_second, part);
}

// Returns the part of the known impulses that leaves the least energy: 1 for those that are still right.
// After a blow they may throw light bodies, and sweeps do not correct that. Call while only these impulses
// are applied.
double RigidWorld::partOfGuess(const Island& island, bool is_second) {
  const Work work = workOf(island);
  if (!(work.square > 0)) return 1;
  return std::clamp((inputOf(island, is_second) - work.along) / work.square, 0.0, 1.0);
}

void RigidWorld::scaleImpulses(const Island& island, double part) {
  for (const int id : bodiesOf(island)) {
    RigidState& s = m_states[at(id)];
    s.velocity = s.velocity_before + part * (s.velocity - s.velocity_before);
    s.spin = s.spin_before + part * (s.spin - s.spin_before);
  }
  for (const int i : constraintsOf(island)) {
    scale(m_constraints[at(i)], part);
  }
  for (const int link : linksOf(island)) m_joints.scale(link, part);
}

// Impulses must not add energy, apart from that of drivers. If they do, the half is swept again, from the
// part of the known impulses that leaves the least energy. If that is not enough, all impulses are reduced.
// The second half may return what the first removed: a bounce, or friction of a contact that ended.
void RigidWorld::guardEnergy(Island& island, bool is_second) {
  constexpr int kRepeatedSweeps = 4;
  Work work = workOf(island);
  double input = 0;
  const auto isGained = [&] {
    const double gain = work.along + 0.5 * work.square;
    const double most = kEnergyRounding * (work.before + work.square) + (is_second ? island.spare : 0);
    if (gain <= most) return false;
    input = inputOf(island, is_second);
    return gain > most + input;
  };
  if (isGained()) {
    ++m_counters.restarts;
    restart(island, is_second, 1);
    const double part = partOfGuess(island, is_second);
    if (part < 1) restart(island, is_second, part);
    sweepIsland(island, is_second, kRepeatedSweeps);
    work = workOf(island);
    input = 0;
    if (isGained()) {
      ++m_counters.scalings;
      const double most = input + (is_second ? island.spare : 0) - work.along;
      scaleImpulses(island, std::clamp(most / work.square, 0.0, 1.0));
      work = workOf(island);
    }
  }
  if (!is_second) island.spare = std::max(0.0, input + work.pull - work.along - 0.5 * work.square);
}

// Solves a contact that was found within the step, after the groups that it connects. Its impulses are
// reduced if they add energy to its two bodies.
void RigidWorld::solveLate(ContactConstraint& c, bool is_second) {
  RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  for (RigidState* p_state : {&a, &b}) {
    p_state->velocity_before = p_state->velocity;
    p_state->spin_before = p_state->spin;
  }
  solveContact(c, m_states, is_second);
  Work work;
  addWork(a, work);
  addWork(b, work);
  if (work.along + 0.5 * work.square <= kEnergyRounding * (work.before + work.square)) return;
  const double input = physics::inputOf(c, m_states);
  if (work.along + 0.5 * work.square <= input + kEnergyRounding * (work.before + work.square)) return;
  ++m_counters.late_scalings;
  const double part = std::clamp((input - work.along) / work.square, 0.0, 1.0);
  for (RigidState* p_state : {&a, &b}) {
    p_state->velocity = p_state->velocity_before + part * (p_state->velocity - p_state->velocity_before);
    p_state->spin = p_state->spin_before + part * (p_state->spin - p_state->spin_before);
  }
  scale(c, part);
}

void RigidWorld::giveUp(Island& island) {
  island.budget = 0;
  for (int i = 0; i < island.bodies; ++i)
    m_extras[at(m_island_bodies[at(island.first_body + i)])].is_given_up = true;
}

bool RigidWorld::solveAtOnce(Island& island, bool is_second) {
  m_direct.begin(bodiesOf(island), m_states);
  std::vector<DirectRow>& rows = m_direct.rows();
  const auto speedOfImmovable = [&](const DirectRow& row, int a, int b) {
    double speed = 0;
    if (row.a < 0 && a >= 0) speed += row.ja * m_states[at(a)].spin - dot(row.n, m_states[at(a)].velocity);
    if (row.b < 0) speed += row.jb * m_states[at(b)].spin + dot(row.n, m_states[at(b)].velocity);
    return speed;
  };
  for (const int link : linksOf(island)) {
    for (const RigidRow& row : m_joints.rowsOfLink(link)) {
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
  for (const int link : linksOf(island)) {
    for (RigidRow& row : m_joints.rowsOfLink(link)) {
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
