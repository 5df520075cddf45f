// Fast bodies: through a sub-step from impact to impact, so that none passes another and no time is lost.
#include <algorithm>
#include <cmath>

#include "physics/geometry/TimeOfImpact.h"
#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

// Of a body in a sub-step: after kMaxBounces impacts it bounces no more, after kMaxImpacts it waits for the
// next sub-step. They bound the cost of a body that is caught in a corner.
constexpr int kMaxImpacts = 64;
constexpr int kMaxBounces = 32;
constexpr double kMaxTurn = 40;   // rad in a sub-step that are swept: bounds the iterations of timeOfImpact()
constexpr int kImpactSweeps = 8;  // over the two points of an impact
// In thicknesses of the thinner body.
constexpr double kTouch = 1e-6;   // gap at which an impact is found
constexpr double kLanded = 0.5;   // how far a body moves at most after it has landed in a large group
constexpr double kMaxRoll = 0.5;  // how far corners turn before others than those found may touch

}  // namespace

void RigidWorld::addFlight(int id, double time) {
  Extra& extra = m_extras[at(id)];
  if (extra.flight >= 0) return;
  extra.flight = static_cast<int>(m_flights.size());
  m_flights.push_back({.id = id, .time = time});
}

RigidWorld::Pose RigidWorld::poseAt(int id, double time, double h) const {
  const RigidState& s = m_states[at(id)];
  const int flight = m_extras[at(id)].flight;
  double left = h * time;
  if (flight >= 0) {
    const Flight& f = m_flights[at(flight)];
    left = f.is_held ? 0 : f.part * h * (time - f.time);
  } else {
    left *= m_extras[at(id)].part;
  }
  if (left == 0) return {s.displacement, s.turn};
  return {s.displacement + left * s.velocity, turned(s.turn, left * s.spin)};
}

void RigidWorld::advance(int id, double time, double h) {
  RigidState& s = m_states[at(id)];
  const Pose pose = poseAt(id, time, h);
  s.displacement = pose.displacement;
  s.turn = pose.turn;
  Flight& flight = m_flights[at(m_extras[at(id)].flight)];
  flight.time = time;
}

void RigidWorld::hold(int id) {
  Flight& flight = m_flights[at(m_extras[at(id)].flight)];
  if (!flight.is_held) ++m_counters.held;
  flight.is_held = true;
}

// Does the solver keep these two shapes apart already?
bool RigidWorld::isSolved(int a, int b, int shape_a, int shape_b) const {
  const std::int32_t index = findPair(a, b);
  if (index < 0 || !m_pairs[at(index)].is_seen) return false;
  for (std::int32_t i = m_pairs[at(index)].first; i >= 0; i = m_contacts[at(i)].next) {
    if (m_contacts[at(i)].shape_a == shape_a && m_contacts[at(i)].shape_b == shape_b) return true;
  }
  return false;
}

void RigidWorld::forecastPair(int one, int other, double h) {
  const int a = std::min(one, other), b = std::max(one, other);
  const std::int32_t known = findPair(a, b);
  if (known >= 0 && m_pairs[at(known)].is_passed) return;
  const Extra &of_a = m_extras[at(a)], &of_b = m_extras[at(b)];
  const auto flightOf = [&](const Extra& e) { return e.flight >= 0 ? &m_flights[at(e.flight)] : nullptr; };
  const Flight *flight_a = flightOf(of_a), *flight_b = flightOf(of_b);
  const auto startOf = [](const Flight* f) { return f != nullptr && !f->is_held ? f->time : 0.0; };
  const double start = std::max(startOf(flight_a), startOf(flight_b)), left = h * (1 - start);
  const bool has_met =
      (flight_a != nullptr && flight_a->impacts > 0) || (flight_b != nullptr && flight_b->impacts > 0);
  const auto motionOf = [&](int id, const Flight* flight) -> RigidMotion {
    const RigidState& s = m_states[at(id)];
    const Rotation rotation = poseAt(id, start, h).turn * m_bodies[at(id)].rotation;
    if (flight != nullptr && flight->is_held) return {{}, rotation, 0};
    const double time = left * (flight != nullptr ? flight->part : m_extras[at(id)].part);
    return {time * s.velocity, rotation, std::clamp(time * s.spin, -kMaxTurn, kMaxTurn)};
  };
  // Of what has turned far since the step began, other corners come to touch than those that were found then.
  const bool is_bending =
      (flight_a != nullptr && flight_a->is_bending) || (flight_b != nullptr && flight_b->is_bending);
  const bool has_turned =
      is_bending || of_a.rolled + of_b.rolled > kMaxRoll * std::min(of_a.thickness, of_b.thickness);
  // At the start of the step they were farther apart than contacts were searched for, if nothing keeps them
  // apart now. Have they come nearer by more than that?
  if (!has_met && !has_turned && of_a.is_restless == of_b.is_restless) {
    const Vec2 nearer = (poseAt(b, 1, h).displacement - of_b.search_displacement) -
                        (poseAt(a, 1, h).displacement - of_a.search_displacement);
    const double most = of_a.margin + of_b.margin - of_a.rolled - of_b.rolled;
    if (most > 0 && lengthSquared(nearer) < most * most) return;
  }
  const RigidMotion motion_a = motionOf(a, flight_a), motion_b = motionOf(b, flight_b);
  const Vec2 offset = (m_bodies[at(b)].place - m_bodies[at(a)].place) +
                      (poseAt(b, start, h).displacement - poseAt(a, start, h).displacement);
  Impact first;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(of_a.shapes.size()); ++i) {
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(of_b.shapes.size()); ++j) {
      if (!has_met && !has_turned && isSolved(a, b, i, j)) continue;
      ++m_counters.sweeps;
      const TimeOfImpact impact =
          timeOfImpact(of_a.shapes[at(i)], motion_a, of_b.shapes[at(j)], motion_b, offset);
      if (impact.status == TimeOfImpactStatus::kApart) continue;
      if (impact.status == TimeOfImpactStatus::kUnresolved) ++m_counters.unresolved;
      const double time = start + (1 - start) * impact.time;
      if (time < first.time) first = {time, a, b, i, j, impact.normal};
    }
  }
  if (first.a >= 0) m_impacts.push_back(first);
}

void RigidWorld::forecast(int id, double h) {
  Extra& extra = m_extras[at(id)];
  const Flight flight = m_flights[at(extra.flight)];
  if (extra.proxy < 0 || flight.is_held || flight.has_landed) return;
  const Place& place = m_bodies[at(id)].place;
  const Vec2 from = m_states[at(id)].displacement, to = poseAt(id, 1, h).displacement;
  const double reach = extra.reach + kTouch * extra.thickness;
  const Bounds swept = {{std::min(from.x, to.x) - reach, std::min(from.y, to.y) - reach},
                        {std::max(from.x, to.x) + reach, std::max(from.y, to.y) + reach}};
  const GridBounds bounds = gridBounds(place, swept, 0);
  m_broad.move(extra.proxy, bounds, bounds);
  m_near.clear();
  m_broad.query(bounds, [&](std::uint32_t other) { m_near.push_back(static_cast<int>(other)); });
  std::sort(m_near.begin(), m_near.end());
  for (const int other : m_near) {
    if (other == id || !(isMovable(id) || isMovable(other)) || m_joints.keepsApart(id, other)) continue;
    forecastPair(id, other, h);
  }
}

// Hit in its sleep: it moves at once, what it lies among wakes in the next step.
void RigidWorld::wakeInFlight(int id) {
  Extra& extra = m_extras[at(id)];
  if (extra.is_active || !isMovable(id)) return;
  wakeRing(id);
  extra.is_active = true;
  m_active.push_back(id);
  m_states[at(id)] = {};
  m_states[at(id)].inverse_mass = m_bodies[at(id)].inverse_mass;
  m_states[at(id)].inverse_inertia = m_bodies[at(id)].inverse_inertia;
}

void RigidWorld::handleImpact(const Impact& impact, double h) {
  const int a = impact.a, b = impact.b;
  ++m_counters.impacts;
  int most = 0;
  for (const int id : {a, b}) {
    wakeInFlight(id);
    addFlight(id, 0);
    Flight& flight = m_flights[at(m_extras[at(id)].flight)];
    if (!flight.is_held) advance(id, impact.time, h);
    if (isMovable(id)) most = std::max(most, ++m_flights[at(m_extras[at(id)].flight)].impacts);
  }
  const RigidState &one = m_states[at(a)], &other = m_states[at(b)];
  const Extra &of_a = m_extras[at(a)], &of_b = m_extras[at(b)];
  TurnedShape turned_a, turned_b;
  turn(of_a.shapes[at(impact.shape_a)], one.turn * m_bodies[at(a)].rotation, turned_a);
  turn(of_b.shapes[at(impact.shape_b)], other.turn * m_bodies[at(b)].rotation, turned_b);
  const Vec2 start = m_bodies[at(b)].place - m_bodies[at(a)].place,
             offset = start + (other.displacement - one.displacement);
  Manifold manifold;
  const double touch = kTouch * std::min(of_a.thickness, of_b.thickness) + 1e-12 * length(offset);
  const auto giveUp = [&] {
    hold(a);
    hold(b);
  };
  if (!collide(turned_a, turned_b, offset, touch, {}, manifold)) return giveUp();
  ContactConstraint& c = addConstraint(a, b);
  beginConstraint(turned_a, turned_b, offset, manifold, c);
  c.first_time = m_time + impact.time * h;
  // In the coordinates of the start of the step.
  c.offset = start;
  for (std::int32_t i = 0; i < c.count; ++i) {
    c.points[at(i)].core_a = inverse(one.turn) * c.points[at(i)].core_a;
    c.points[at(i)].core_b = inverse(other.turn) * c.points[at(i)].core_b;
  }
  if (c.kind == ContactKind::kFaceA) c.first_normal = inverse(one.turn) * c.first_normal;
  if (c.kind == ContactKind::kFaceB) c.first_normal = inverse(other.turn) * c.first_normal;
  refresh(c, m_states);
  applyImpact(c, most > kMaxBounces ? 0 : c.restitution, impact.time);
  if (most > kMaxImpacts) giveUp();
  for (const int id : {a, b}) {
    if (isMovable(id) && m_extras[at(id)].is_in_crowd) land(id, h);
  }
}

// A body that has hit something in a large group is swept no more, or every body of the group would be: it
// moves on a little, and its contacts are searched again before the next sub-step.
void RigidWorld::land(int id, double h) {
  Extra& extra = m_extras[at(id)];
  Flight& flight = m_flights[at(extra.flight)];
  const RigidState& s = m_states[at(id)];
  const double movement = h * (1 - flight.time) * (length(s.velocity) + std::fabs(s.spin) * extra.reach);
  const double most = kLanded * extra.thickness;
  flight.part = movement > most ? most / movement : 1;
  flight.has_landed = true;
  extra.is_restless = m_is_restless = true;
}

// The impact's impulses, at once. Velocities are those of the middle of the sub-step: what acceleration adds
// until then, or has added since, is not there at the impact.
void RigidWorld::applyImpact(ContactConstraint& c, double restitution, double time) {
  RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    const double speed = dot(c.normal, b.velocity - a.velocity) + (p.normal_b * b.spin - p.normal_a * a.spin);
    const double gained = 2 * (dot(c.normal, b.kick - a.kick));
    const double since = (time - 0.5) * gained;
    const double leaving = restitution * -std::min(speed + since, 0.0);
    p.after = leaving > 2 * std::fabs(gained) ? leaving - since : 0;
    p.normal_impulse = p.friction_impulse = 0;
  }
  for (int i = 0; i < kImpactSweeps; ++i) solveContact(c, m_states, true);
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    p.total += p.normal_impulse;
    p.normal_impulse = p.friction_impulse = p.normal_warm = p.friction_warm = 0;
    p.is_bouncing = false;
  }
}

void RigidWorld::sweep(double h) {
  m_impacts.clear();
  for (std::size_t i = 0; i < m_flights.size(); ++i) forecast(m_flights[i].id, h);
  while (!m_impacts.empty()) {
    const auto isBefore = [](const Impact& x, const Impact& y) {
      if (x.time != y.time) return x.time < y.time;
      return x.a != y.a ? x.a < y.a : x.b < y.b;
    };
    const Impact next = *std::min_element(m_impacts.begin(), m_impacts.end(), isBefore);
    handleImpact(next, h);
    std::erase_if(m_impacts, [&](const Impact& i) {
      const auto isOf = [&](int id) { return isMovable(id) && (i.a == id || i.b == id); };
      return isOf(next.a) || isOf(next.b);
    });
    for (const int id : {next.a, next.b}) {
      if (isMovable(id)) forecast(id, h);  // nothing changes the path of the others
    }
  }
}

}  // namespace naiad::physics
