// The step of a RigidWorld and its sub-steps: the movement of bodies, and the order of the solver's stages.
#include <algorithm>
#include <cmath>

#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

constexpr double kFarthest = 1e9;      // metric cells in one step; the limit of timeOfImpact()
constexpr double kFarthestTurn = 1e9;  // rad in one step; if a body turns farther, it is frozen
// Distances in units of a body's thickness, the smallest half width of its shapes:
constexpr double kSlack = 0.02;       // minimum margin of the search for contacts
constexpr double kBoundsSlack = 0.1;  // margin of bounds in the broad phase; smaller moves do not change them
constexpr double kFast = 0.25;        // a large group is abandoned if a body moves farther in a step

}  // namespace

void RigidWorld::beginBody(int id, double dt) {
  Extra& extra = m_extras[at(id)];
  const RigidBody& body = m_bodies[at(id)];
  const bool is_movable = isMovable(id);
  Vec2 acceleration;
  double spin_gain = 0;
  if (body.inverse_mass > 0) acceleration = body.acceleration;
  if (body.inverse_inertia > 0) spin_gain = body.inverse_inertia * body.torque;
  const Vec2 displacement = dt * body.velocity + (0.5 * dt * dt) * acceleration;
  const double angle = dt * (std::fabs(body.spin) + 0.5 * dt * std::fabs(spin_gain));
  const double gained = dt * dt * (std::fabs(acceleration.x) + std::fabs(acceleration.y));
  if (!(std::fabs(displacement.x) + std::fabs(displacement.y) + gained < kFarthest &&
        angle < kFarthestTurn)) {
    freeze(id);
    return;
  }
  RigidState& state = m_states[at(id)];
  state = {};
  state.velocity = body.velocity;
  state.spin = body.spin;
  if (is_movable) {
    state.setMass(body.inverse_mass, body.inverse_inertia);
    setKick(state, acceleration, body.jerk, m_h, m_options.substeps);
    state.spin_kick = 0.5 * m_h * spin_gain;
  }
  extra.moved = extra.rolled = 0;
  extra.is_given_up = extra.is_pushed = extra.is_touched = false;
  if (extra.proxy < 0) return;
  const double movement = length(displacement) + std::min(angle, 2.0) * extra.reach;
  extra.margin = std::min(movement, extra.thickness) + kSlack * extra.thickness;
  extra.is_fast = movement > kFast * extra.thickness;
  const Bounds bounds = turnShapes(id, body.rotation);
  m_broad.move(extra.proxy, gridBounds(body.place, bounds, extra.margin),
               gridBounds(body.place, bounds, extra.margin + kBoundsSlack * extra.thickness));
}

void RigidWorld::sortByOrder(std::vector<int>& ids) const {
  const auto isLess = [this](int a, int b) { return isBefore(a, b); };
  if (!std::is_sorted(ids.begin(), ids.end(), isLess)) std::sort(ids.begin(), ids.end(), isLess);
}

void RigidWorld::beginStep(double dt) {
  m_events.clear();
  m_constraints.clear();
  m_late.swap(m_late_before);
  m_late.clear();
  m_time = 0;
  m_h = dt / m_options.substeps;
  m_deepest = 0;
  m_has_flown = false;
  if (m_active_changed) {
    m_active_changed = false;
    m_active.clear();
    for (int id = 0; id < idLimit(); ++id) {
      Extra& extra = m_extras[at(id)];
      extra.is_active = extra.exists && !extra.is_frozen && (isMovable(id) ? !extra.is_asleep : isMoving(id));
      if (extra.is_active) {
        m_active.push_back(id);
      } else {
        m_states[at(id)] = {};
      }
    }
    sortByOrder(m_active);
  }
  for (const int id : m_dirty) {
    Extra& extra = m_extras[at(id)];
    if (!extra.exists || extra.is_frozen || isMovable(id)) continue;
    if (!extra.is_active) {
      beginBody(id, dt);
      m_states[at(id)] = {};
    }
  }
  for (std::size_t i = 0; i < m_active.size(); ++i) beginBody(m_active[i], dt);
  if (m_active_changed) {  // a body was frozen, and must be removed
    std::erase_if(m_active, [&](int id) {
      Extra& extra = m_extras[at(id)];
      if (extra.is_frozen) extra.is_active = false;
      return extra.is_frozen;
    });
  }
}

void RigidWorld::kick(bool is_second) {
  for (const int id : m_active) {
    RigidState& s = m_states[at(id)];
    s.velocity += s.kick;
    s.spin += s.spin_kick;
    if (!is_second) s.free_velocity = s.velocity;
    s.velocity_before = s.velocity;
    s.spin_before = s.spin;
    if (is_second) s.kick += s.kick_growth;
  }
}

// Applies magnets when the velocities are those that contacts and joints allow. Then groups with a magnet are
// solved again, to find how much of the magnet's push contacts and joints leave.
void RigidWorld::turnByMagnets(double h) {
  m_magnets.clear();
  for (const int id : m_active) {
    const double rate = m_bodies[at(id)].turn_rate;
    RigidState& s = m_states[at(id)];
    if (rate == 0 || s.inverse_mass == 0) continue;
    const MagnetTurn turn = magnetTurn(s.velocity, rate, h);
    s.velocity += turn.push;
    m_magnets.emplace_back(id, turn);
  }
  if (m_magnets.empty()) return;
  for (Island& island : m_islands) {
    const auto begin = m_island_bodies.begin() + island.first_body;
    const bool has_magnet =
        std::any_of(begin, begin + island.bodies, [&](int id) { return m_bodies[at(id)].turn_rate != 0; });
    if (has_magnet && island.constraints + island.links > 0) solveIsland(island, true);
  }
  for (const auto& [id, turn] : m_magnets) {
    Vec2& velocity = m_states[at(id)].velocity;
    velocity = withoutWork(turn, velocity, 0);
  }
}

// Undoes overlap, with the number of sweeps that each group needs.
void RigidWorld::pushOut(double h) {
  const auto sweepsOf = [&](int id) {
    return m_extras[at(id)].is_active && isMovable(id) ? m_extras[at(id)].push_sweeps : 0;
  };
  const bool has_joints = !m_joints.rows().empty();
  for (int i = 0; i < (has_joints ? kPushSweeps : 1); ++i) {
    for (ContactConstraint& c : m_constraints) {
      if (i == 0 || i < std::max(sweepsOf(c.a), sweepsOf(c.b))) pushApart(c, m_states);
    }
    m_joints.hold(m_states);
  }
  for (const int id : m_active) {
    RigidState& s = m_states[at(id)];
    if (!s.is_pushed) continue;
    m_extras[at(id)].is_pushed = true;
    s.displacement += h * s.push;
    s.turn = turned(s.turn, h * s.push_spin);
    s.push = {};
    s.push_spin = 0;
    s.is_pushed = false;
  }
}

void RigidWorld::solve(bool is_second) {
  for (Island& island : m_islands) {
    if (island.linkage >= 0 && island.constraints == 0) {
      if (island.links > 0) m_linkages[at(island.linkage)].project(m_states, m_joints);
      continue;
    }
    solveIsland(island, is_second);
    guardEnergy(island, is_second);
  }
  for (std::size_t i = m_first_late; i < m_constraints.size(); ++i) {
    solveLate(m_constraints[i], is_second);
  }
}

void RigidWorld::move(int id, double h) {
  RigidState& s = m_states[at(id)];
  s.displacement += h * s.velocity;
  s.turn = turned(s.turn, h * s.spin);
}

// True if the shapes of a ballistic contact may touch in this sub-step. The distance of two shapes changes at
// most by their relative movement and by what rotation moves their points.
bool RigidWorld::mayMeet(const ContactConstraint& c, double h) const {
  if (c.count == 0 || c.pair < 0) return c.count > 0;
  const RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  const double way = length(b.displacement - a.displacement) + h * length(b.velocity - a.velocity) +
                     0.25 * h * length(bendOf(c.b) - bendOf(c.a));
  return c.first_gap <= way + m_extras[at(c.a)].rolled + m_extras[at(c.b)].rolled;
}

// Moves the bodies. Those that move farther than contacts were searched for move from impact to impact.
void RigidWorld::drift(double h) {
  m_flights.clear();
  findPushedLinkages();
  for (const int id : m_active) {
    Extra& extra = m_extras[at(id)];
    const RigidState& s = m_states[at(id)];
    if (extra.proxy < 0) continue;
    const double roll = h * std::fabs(s.spin) * extra.reach;
    extra.rolled += roll;
    extra.moved += h * length(s.velocity) + roll;
    if (extra.moved > extra.margin) addFlight(id, 0);
  }
  for (const ContactConstraint& c : m_constraints) {
    const bool is_ballistic = c.is_ballistic || c.points[0].is_bending || c.points[1].is_bending;
    if (c.contact >= 0) {
      m_contacts[at(c.contact)].is_ballistic = is_ballistic;
      m_contacts[at(c.contact)].rests = !c.is_ballistic;
    }
    if (!is_ballistic || !mayMeet(c, h)) continue;
    for (const int id : {c.a, c.b}) {
      if (isMovable(id)) addFlight(id, 0);
    }
  }
  m_has_flown = m_has_flown || !m_flights.empty();
  if (!m_flights.empty()) sweep(h);
  for (const int id : m_active) {
    if (m_extras[at(id)].flight < 0) move(id, h);
  }
  for (const Flight& flight : m_flights) {
    if (!flight.is_held) advance(flight.id, 1, h);
  }
  for (const Flight& flight : m_flights) {
    Extra& extra = m_extras[at(flight.id)];
    extra.flight = -1;
    extra.is_pushed = extra.is_pushed || flight.is_held;
    if (flight.impacts == 0) continue;
    if (flyingLinkageOf(flight.id) >= 0) {  // what the second half of its RATTLE sub-step needs
      RigidState& its = m_states[at(flight.id)];
      its.velocity += flight.last * (flight.bend - its.kick);
    }
    // Impacts may have made the body faster.
    const RigidState& s = m_states[at(flight.id)];
    const double roll = h * std::fabs(s.spin) * extra.reach;
    extra.rolled += roll;
    extra.moved += h * length(s.velocity) + roll;
  }
}

bool RigidWorld::isFlying(int id) const {
  const Extra& extra = m_extras[at(id)];
  return extra.is_active && extra.moved > extra.margin;
}

// Drops contacts of fast bodies that are not close any more, because rotation may have moved the contact's
// plane. These bodies are swept, and make a new contact if they touch again.
void RigidWorld::dropParted() {
  for (ContactConstraint& c : m_constraints) {
    if (c.count == 0 || c.points[0].is_bouncing || c.points[1].is_bouncing) continue;
    const Extra &a = m_extras[at(c.a)], &b = m_extras[at(c.b)];
    const double thickness = std::min(a.thickness, b.thickness);
    if (c.pair >= 0) {
      if (!(isFlying(c.a) || isFlying(c.b)) || a.rolled + b.rolled <= kMaxRoll * thickness) continue;
      const double least =
          c.count > 1 ? std::min(c.points[0].separation, c.points[1].separation) : c.points[0].separation;
      if (least <= thickness && (least >= -thickness || c.is_deep)) continue;
    } else {
      const RigidState &one = m_states[at(c.a)], &other = m_states[at(c.b)];
      const ContactPoint& p = c.points[0];
      const Vec2 between =
          c.offset + (other.displacement - one.displacement) + (other.turn * p.core_b - one.turn * p.core_a);
      const double near = c.radius_a + c.radius_b + thickness;
      if (lengthSquared(between) <= near * near) continue;
    }
    c.count = 0;
    c.is_ballistic = false;
    c.inverse_determinant = 0;
    for (ContactPoint& p : c.points) {
      p.total += p.normal_impulse;
      if (p.total > 0 && c.first_time < 0) c.first_time = m_time;
      p.separation = thickness;
      p.normal_impulse = p.friction_impulse = p.normal_warm = p.friction_warm = 0;
      p.is_bouncing = p.is_bending = false;
    }
  }
}

void RigidWorld::substep(double h) {
  bool is_deep = false;
  for (ContactConstraint& c : m_constraints) {
    if (physics::beginSubstep(c, m_states, h)) is_deep = true;
  }
  for (std::size_t i = m_first_late; i < m_constraints.size(); ++i) dropGuess(m_constraints[i]);
  kick(false);
  m_joints.beginFirstHalf(m_states, h);
  for (ContactConstraint& c : m_constraints) beginFirstHalf(c, m_states);
  solve(false);
  aimLinkages(h);
  if (is_deep) pushOut(h);
  drift(h);
  fitLinkages();
  m_joints.refresh(m_states);
  for (ContactConstraint& c : m_constraints) physics::refresh(c, m_states);
  if (m_has_flown) dropParted();
  kick(true);
  m_joints.beginSecondHalf(m_states, h);
  for (ContactConstraint& c : m_constraints) beginSecondHalf(c, m_states, h);
  solve(true);
  turnByMagnets(h);
  dampLinkages();
  m_joints.endSubstep();
  for (ContactConstraint& c : m_constraints) {
    const double before = c.points[0].total + c.points[1].total;
    for (std::int32_t i = 0; i < c.count; ++i) c.points[at(i)].total += c.points[at(i)].normal_impulse;
    if (before == 0 && c.points[0].total + c.points[1].total > 0 && c.first_time < 0) c.first_time = m_time;
  }
  m_time += h;
}

void RigidWorld::finishStep(double dt) {
  for (const int id : m_active) {
    RigidBody& body = m_bodies[at(id)];
    const RigidState& s = m_states[at(id)];
    if (!isFinite(s.velocity) || !isFinite(s.displacement) || !(s.spin - s.spin == 0) ||
        !(std::fabs(s.displacement.x) + std::fabs(s.displacement.y) < 1e12)) {
      freeze(id);
      continue;
    }
    body.place = body.place + s.displacement;
    if (s.turn != Rotation{}) body.rotation = renormalised(s.turn * body.rotation);
    if (isMovable(id)) {
      body.velocity = s.velocity;
      body.spin = s.spin;
    }
  }
  for (const ContactConstraint& c : m_constraints) {
    storeContact(c, m_h);
    publishBegin(c, dt);
  }
  publishEnds(dt);
  m_counters.broken += m_joints.end(dt, m_h);
  sleep(dt);
  for (const int id : m_dirty) m_extras[at(id)].is_dirty = false;
  m_dirty.clear();
  sortEvents();
}

void RigidWorld::stepOnce(double dt) {
  beginStep(dt);
  updatePairs();
  updateContacts(dt);
  findLinkages();
  m_joints.begin(m_bodies, m_states, m_h,
                 [&](int id) { return m_extras[at(id)].is_active && isMovable(id); });
  beginLinkages();
  findIslands();
  gatherIslands();
  for (int i = 0; i < m_options.substeps; ++i) substep(m_h);
  moveLinkages();
  finishStep(dt);
}

void RigidWorld::step() {
  ++m_counters.ticks;
  stepOnce(1);
}

}  // namespace naiad::physics
