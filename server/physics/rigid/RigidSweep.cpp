// Moves fast bodies through a sub-step from impact to impact, so that none passes another or loses time.
#include <algorithm>
#include <cmath>

#include "physics/geometry/TimeOfImpact.h"
#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

// After more impacts in a sub-step, a body waits for the next one.
constexpr int kMaxImpacts = 64;
// After more impacts in a sub-step, a body lands unless it is elastic: of a group of more than three bodies,
// and others.
constexpr int kGroupImpacts = 4;
constexpr int kFreeImpacts = 16;
// Maximum calls of timeOfImpact() for a pair; each starts where the iterations of the last call ended. Limits
// the cost of two bodies that rotate fast around each other.
constexpr int kMaxAsked = 16;
constexpr int kImpactSweeps = 8;  // sweeps over the points of an impact with friction
// Lengths in units of the thinner body's thickness:
constexpr double kTouch = 1e-6;  // the gap at which an impact is found
// Both corners of an edge take part in an impact if the gap of the second is at most this. Otherwise a box
// that falls almost flat would be thrown by one corner, and a column of boxes would fall over.
constexpr double kTogether = 1e-3;
// Bodies at rest on each other may come nearer by this between two impacts. Without it, a box that rocks on
// its corner would hit the floor many times, because in a sub-step its centre moves straight.
constexpr double kGive = 1e-3;
constexpr double kLanded = 0.5;  // maximum further movement of a body of a large group that has landed

// Returns what remains of a motion after this part of it.
RigidMotion after(const RigidMotion& motion, double part) {
  const double left = 1 - part;
  return {left * (motion.displacement + part * motion.acceleration), turned(motion.start, part * motion.turn),
          left * motion.turn, left * left * motion.acceleration};
}

// Like timeOfImpact(), but if the iterations ended too early, calls it again from there.
TimeOfImpact patientTimeOfImpact(const ConvexShape& a, const RigidMotion& motion_a, const ConvexShape& b,
                                 const RigidMotion& motion_b, Vec2 offset, double give) {
  TimeOfImpact impact = timeOfImpact(a, motion_a, b, motion_b, offset, 0, give);
  for (int i = 1; i < kMaxAsked && impact.status == TimeOfImpactStatus::kUnresolved; ++i) {
    const double from = impact.time;
    const Vec2 apart = offset + (motion_b.at(from) - motion_a.at(from));
    impact = timeOfImpact(a, after(motion_a, from), b, after(motion_b, from), apart, 0, give);
    impact.time = from + (1 - from) * impact.time;
  }
  return impact;
}

}  // namespace

void RigidWorld::addFlight(int id, double time) {
  Extra& extra = m_extras[at(id)];
  if (extra.flight >= 0) return;
  const Vec2 bend = bendOf(id);
  const double spin_bend = spinBendOf(id);
  extra.flight = static_cast<int>(m_flights.size());
  m_flights.push_back({.id = id, .time = time, .bend = bend, .spin_bend = spin_bend});
}

// Returns half of the change of the body's velocity by acceleration in the sub-step, if nothing pushes it:
// its path is a parabola. `velocity` is that of the middle of the sub-step. The forces of its linkage bend it
// too. The path of a body that is pushed is a straight line.
Vec2 RigidWorld::bendOf(int id) const {
  const Extra& extra = m_extras[at(id)];
  const RigidState& s = m_states[at(id)];
  if (extra.flight >= 0) return m_flights[at(extra.flight)].bend;
  const int linkage = flyingLinkageOf(id);
  if (linkage >= 0 && m_pushed_linkages[at(linkage)] == 0) return s.velocity - (s.velocity_before - s.kick);
  return s.velocity == s.free_velocity ? s.kick : Vec2{};
}

double RigidWorld::spinBendOf(int id) const {
  const RigidState& s = m_states[at(id)];
  const int linkage = flyingLinkageOf(id);
  if (linkage >= 0 && m_pushed_linkages[at(linkage)] == 0) return s.spin - (s.spin_before - s.spin_kick);
  return s.spin_kick;
}

RigidWorld::Pose RigidWorld::poseAt(int id, double time, double h) const {
  const RigidState& s = m_states[at(id)];
  const int flight = m_extras[at(id)].flight;
  double from = 0, left = h * time;
  if (flight >= 0) {
    const Flight& f = m_flights[at(flight)];
    from = f.time;
    left = f.is_held ? 0 : f.part * h * (time - f.time);
  }
  if (left == 0) return {s.displacement, s.turn};
  const Vec2 velocity = s.velocity + (time + from - 1) * bendOf(id);
  return {s.displacement + left * velocity, turned(s.turn, left * s.spin)};
}

void RigidWorld::advance(int id, double time, double h) {
  RigidState& s = m_states[at(id)];
  const Pose pose = poseAt(id, time, h);
  s.displacement = pose.displacement;
  s.turn = pose.turn;
  m_flights[at(m_extras[at(id)].flight)].time = time;
}

void RigidWorld::hold(int id) {
  if (!isMovable(id)) return;
  Flight& flight = m_flights[at(m_extras[at(id)].flight)];
  if (flight.is_held) return;
  ++m_counters.held;
  flight.is_held = true;
  // While it waits, nothing accelerates it, so that it gains no energy.
  m_states[at(id)].velocity -= (2 * (1 - flight.time)) * flight.bend;
}

// Returns the contact of two shapes in this step; null: none.
const RigidContact* RigidWorld::contactOf(const Pair& pair, int shape_a, int shape_b) const {
  for (std::int32_t i = pair.first; i >= 0; i = m_contacts[at(i)].next) {
    if (m_contacts[at(i)].shape_a == shape_a && m_contacts[at(i)].shape_b == shape_b)
      return &m_contacts[at(i)];
  }
  return nullptr;
}

// True if an impact within this step has left the two bodies at rest on each other.
bool RigidWorld::haveLanded(int a, int b) const {
  for (std::size_t i = m_constraints.size(); i > m_first_late; --i) {
    const ContactConstraint& c = m_constraints[i - 1];
    if (c.a == a && c.b == b) return c.count > 0 && !c.is_ballistic;
  }
  return false;
}

void RigidWorld::forecastPair(int one, int other, double h) {
  const int a = isBefore(one, other) ? one : other, b = a == one ? other : one;
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
    if (flight != nullptr && flight->is_held) return {{}, rotation, 0, {}};
    const double time = flight != nullptr ? left * flight->part : left;
    const Vec2 bend = bendOf(id);
    return {time * (s.velocity + (2 * start - 1) * bend), rotation, time * s.spin,
            (2 * (1 - start) * time) * bend};
  };
  // Once a body has turned far since the step began, other corners may touch than those found at its start.
  const bool has_turned = of_a.rolled + of_b.rolled > kMaxRoll * std::min(of_a.thickness, of_b.thickness);
  const bool is_known = !has_met && !has_turned;
  const std::int32_t index = has_turned ? -1 : findPair(a, b);
  const Pair* p_pair = index >= 0 && m_pairs[at(index)].is_seen ? &m_pairs[at(index)] : nullptr;
  // At the start of the step, shapes without a contact were farther apart than the distance to which contacts
  // were searched. They cannot touch unless they approach by more than that distance.
  bool is_near = false;
  if (is_known) {
    const double bulge = 0.25 * h * length(bendOf(b) - bendOf(a));
    const double most = of_a.margin + of_b.margin - of_a.rolled - of_b.rolled - bulge;
    const auto isNear = [&](double time) {
      return lengthSquared(poseAt(b, time, h).displacement - poseAt(a, time, h).displacement) < most * most;
    };
    is_near = most > 0 && isNear(1) && isNear(start);
    if (is_near && (p_pair == nullptr || p_pair->first < 0)) return;
  }
  const RigidMotion motion_a = motionOf(a, flight_a), motion_b = motionOf(b, flight_b);
  const Vec2 offset = (m_bodies[at(b)].place - m_bodies[at(a)].place) +
                      (poseAt(b, start, h).displacement - poseAt(a, start, h).displacement);
  const bool has_landed = has_met && haveLanded(a, b);
  const bool is_joined = flyingLinkageOf(a) >= 0 || flyingLinkageOf(b) >= 0;
  Impact first;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(of_a.shapes.size()); ++i) {
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(of_b.shapes.size()); ++j) {
      const RigidContact* p_contact = p_pair != nullptr ? contactOf(*p_pair, i, j) : nullptr;
      if (is_known && (p_contact != nullptr ? !p_contact->is_ballistic : is_near)) continue;
      const bool rests = has_landed || (!is_joined && p_contact != nullptr && p_contact->rests);
      ++m_counters.sweeps;
      const TimeOfImpact impact =
          patientTimeOfImpact(of_a.shapes[at(i)], motion_a, of_b.shapes[at(j)], motion_b, offset,
                              rests ? kGive * std::min(of_a.thickness, of_b.thickness) : 0);
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
  const double reach = extra.reach + kTouch * extra.thickness + 0.25 * h * length(flight.bend);
  const Bounds swept = {{std::min(from.x, to.x) - reach, std::min(from.y, to.y) - reach},
                        {std::max(from.x, to.x) + reach, std::max(from.y, to.y) + reach}};
  const GridBounds bounds = gridBounds(place, swept, 0);
  m_broad.move(extra.proxy, bounds, bounds);
  m_near.clear();
  m_broad.query(bounds, [&](std::uint32_t other) { m_near.push_back(static_cast<int>(other)); });
  sortByOrder(m_near);
  for (const int other : m_near) {
    if (other == id || !(isMovable(id) || isMovable(other)) || m_joints.keepsApart(id, other)) continue;
    forecastPair(id, other, h);
  }
}

// Wakes a sleeping body that was hit. It moves at once; other bodies of its group move from the next step on.
void RigidWorld::wakeInFlight(int id) {
  Extra& extra = m_extras[at(id)];
  if (extra.is_active || !isMovable(id)) return;
  wakeRing(id);
  extra.is_active = true;
  m_active.push_back(id);
  extra.push_sweeps = 1;
  extra.margin = extra.moved = extra.rolled = 0;  // no contacts were searched around this body
  m_states[at(id)] = {};
  m_states[at(id)].setMass(m_bodies[at(id)].inverse_mass, m_bodies[at(id)].inverse_inertia);
}

void RigidWorld::handleImpact(const Impact& impact, double h) {
  const int a = impact.a, b = impact.b;
  m_met.clear();
  for (const int id : {a, b}) {
    if (isMovable(id)) m_met.push_back(id);
  }
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
  RotatedShape turned_a, turned_b;
  turn(of_a.shapes[at(impact.shape_a)], one.turn * m_bodies[at(a)].rotation, turned_a);
  turn(of_b.shapes[at(impact.shape_b)], other.turn * m_bodies[at(b)].rotation, turned_b);
  const Vec2 start = m_bodies[at(b)].place - m_bodies[at(a)].place,
             offset = start + (other.displacement - one.displacement);
  Manifold manifold;
  // Rounding error of the places, of the time of impact, and of the rotations at that time.
  const double resolved = 1e-12 * (length(offset) + of_a.reach + of_b.reach) +
                          1e-15 * h *
                              (length(other.velocity - one.velocity) + std::fabs(one.spin) * of_a.reach +
                               std::fabs(other.spin) * of_b.reach);
  const double touch = kTouch * std::min(of_a.thickness, of_b.thickness) + resolved;
  // A body that waited in front of a moving wall would end up inside the wall, so it moves with the wall.
  const auto giveUp = [&] {
    hold(a);
    hold(b);
    if (isMovable(a) == isMovable(b)) return;
    const int wall = isMovable(a) ? b : a, id = isMovable(a) ? a : b;
    if (!isMoving(wall) || most > 2 * kMaxImpacts) return;
    const RigidState& its = m_states[at(wall)];
    RigidState& own = m_states[at(id)];
    const Vec2 arm = isMovable(a) ? -offset : offset;
    own.velocity = its.velocity + its.spin * perpendicular(arm);
    own.spin = its.spin;
    m_flights[at(m_extras[at(id)].flight)].is_held = false;
  };
  const double together = touch + kTogether * std::min(of_a.thickness, of_b.thickness);
  if (!collide(turned_a, turned_b, offset, together, {}, manifold)) return giveUp();
  if (std::min(manifold.points[0].separation, manifold.points[at(manifold.count - 1)].separation) > touch)
    return giveUp();
  ContactConstraint& c = addConstraint(a, b);
  if (hasFrictionParts()) c.friction = frictionOf(a, b, manifold);
  beginConstraint(turned_a, turned_b, offset, manifold, c);
  c.first_time = m_time + impact.time * h;
  measureFromStart(c, start, one, other);
  refresh(c, m_states);
  const std::int32_t index = findPair(a, b);
  c.is_kept = index >= 0 && m_pairs[at(index)].is_touching;
  gatherMet(a, b, impact.time, h);
  if (flyingLinkageOf(a) >= 0 || flyingLinkageOf(b) >= 0) {
    applyJoinedImpact(c, impact.time, h);
  } else {
    applyImpact(c, impact.time);
  }
  if (most > kMaxImpacts) giveUp();
  for (const int id : {a, b}) {
    const Extra& extra = m_extras[at(id)];
    if (!isMovable(id)) continue;
    const int free_impacts = extra.is_in_group ? kGroupImpacts : kFreeImpacts;
    const bool is_spent = c.restitution < 1 && m_flights[at(extra.flight)].impacts > free_impacts;
    if (is_spent || (extra.is_in_crowd && !c.may_fly)) land(id, h);
  }
}

// Ends the sweep of a body of a large group, or of a group with joints, after an impact, because otherwise
// all bodies of the group would be swept; also after many impacts that lose energy. In the rest of this
// sub-step the body moves at most by kLanded.
void RigidWorld::land(int id, double h) {
  const Extra& extra = m_extras[at(id)];
  Flight& flight = m_flights[at(extra.flight)];
  const RigidState& s = m_states[at(id)];
  const double movement = h * (1 - flight.time) * (length(s.velocity) + std::fabs(s.spin) * extra.reach);
  const double most = kLanded * extra.thickness;
  flight.part = movement > most ? most / movement : 1;
  flight.has_landed = true;
}

// Applies the impulses of an impact at its time. The states have the velocities of the sub-step's middle.
void RigidWorld::applyImpact(ContactConstraint& c, double time) {
  RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  const double since = 2 * time - 1;
  const Vec2 bend_a = bendOf(c.a), bend_b = bendOf(c.b);
  const auto shift = [&](double part) {
    a.velocity += part * bend_a, a.spin += part * a.spin_kick;
    b.velocity += part * bend_b, b.spin += part * b.spin_kick;
  };
  shift(since);
  const double rest_speed = restSpeed(c, m_states);
  const double rest_after = since * dot(c.normal, bend_b - bend_a);
  const bool rests =
      c.friction > 0 ? rub(c, rest_speed, rest_after) : bounce(c, m_states, rest_speed, rest_after);
  shift(-since);
  c.is_ballistic = c.restitution > 0 && c.may_fly && !rests;
  // Bodies at rest on each other fall together. If one of them cannot fall, neither does the other.
  const double share = a.inverse_mass / (a.inverse_mass + b.inverse_mass);
  const Vec2 bend = bend_a != Vec2{} && bend_b != Vec2{} ? bend_a + share * (bend_b - bend_a) : Vec2{};
  if (rests)
    m_flights[at(m_extras[at(c.a)].flight)].bend = m_flights[at(m_extras[at(c.b)].flight)].bend = bend;
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    p.total += p.normal_impulse;
    p.normal_impulse = p.friction_impulse = p.normal_warm = p.friction_warm = 0;
    p.is_bouncing = false;
  }
}

// bounce() with friction.
bool RigidWorld::rub(ContactConstraint& c, double rest_speed, double rest_after) {
  const double restitution = c.restitution;
  RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  const RigidState a_before = a, b_before = b;
  bool rests = false;
  const auto meet = [&](double part) {
    rests = false;
    for (std::int32_t i = 0; i < c.count; ++i) {
      ContactPoint& p = c.points[at(i)];
      const double approach =
          -(dot(c.normal, b.velocity - a.velocity) + (p.normal_b * b.spin - p.normal_a * a.spin));
      const bool leaves = part * approach > rest_speed;
      p.after = leaves ? part * approach : rest_after;
      rests = rests || (approach > 0 && !leaves);
      p.normal_impulse = p.friction_impulse = 0;
    }
    for (int i = 0; i < kImpactSweeps; ++i) solveContact(c, m_states, true);
  };
  const auto energyGained = [&] {
    double gain = 0;
    for (std::int32_t i = 0; i < c.count; ++i) {
      const ContactPoint& p = c.points[at(i)];
      const auto work = [&](const RigidState& of_a, const RigidState& of_b) {
        const Vec2 speed = of_b.velocity - of_a.velocity;
        return p.normal_impulse * (dot(c.normal, speed) + p.normal_b * of_b.spin - p.normal_a * of_a.spin) +
               p.friction_impulse *
                   (dot(perpendicular(c.normal), speed) + p.tangent_b * of_b.spin - p.tangent_a * of_a.spin);
      };
      gain += 0.5 * (work(a_before, b_before) + work(a, b));
    }
    return gain;
  };
  meet(restitution);
  // With friction, these impulses may increase the kinetic energy. The impulses that stop the approach cannot
  // increase it, even if they are multiplied by 1 + e. The energy is a convex function of the impulses, so a
  // weighted mean of the two sets increases it by at most the weighted mean of the two increases. The weight
  // is chosen so that this is 0.
  const double gain = restitution > 0 ? energyGained() : 0;
  if (gain > 0) {
    const RigidState a_wanted = a, b_wanted = b;
    std::array<Vec2, 2> wanted;
    const auto impulses = [&](std::size_t i) -> Vec2 {
      return {c.points[i].normal_impulse, c.points[i].friction_impulse};
    };
    const auto move = [&](std::size_t i, Vec2 to) {
      c.points[i].normal_impulse = to.x, c.points[i].friction_impulse = to.y;
    };
    const auto mix = [](const RigidState& from, const RigidState& to, double part, RigidState& out) {
      const Vec2 velocity = from.velocity + part * (to.velocity - from.velocity);
      const double spin = from.spin + part * (to.spin - from.spin);
      out.velocity = velocity, out.spin = spin;
    };
    for (std::size_t i = 0; i < at(c.count); ++i) wanted[i] = impulses(i);
    a = a_before, b = b_before;
    meet(0);
    mix(a_before, a, 1 + restitution, a);
    mix(b_before, b, 1 + restitution, b);
    for (std::size_t i = 0; i < at(c.count); ++i) move(i, (1 + restitution) * impulses(i));
    const double loss = std::min(energyGained(), 0.0), part = loss / (loss - gain);
    mix(a, a_wanted, part, a);
    mix(b, b_wanted, part, b);
    for (std::size_t i = 0; i < at(c.count); ++i) move(i, impulses(i) + part * (wanted[i] - impulses(i)));
    rests = false;
  }
  return rests;
}

void RigidWorld::sweep(double h) {
  m_impacts.clear();
  for (std::size_t i = 0; i < m_flights.size(); ++i) forecast(m_flights[i].id, h);
  while (!m_impacts.empty()) {
    const auto isEarlier = [this](const Impact& x, const Impact& y) {
      if (x.time != y.time) return x.time < y.time;
      return x.a != y.a ? isBefore(x.a, y.a) : isBefore(x.b, y.b);
    };
    const Impact next = *std::min_element(m_impacts.begin(), m_impacts.end(), isEarlier);
    handleImpact(next, h);
    std::erase_if(m_impacts, [&](const Impact& i) {
      return std::any_of(m_met.begin(), m_met.end(), [&](int id) { return i.a == id || i.b == id; });
    });
    for (const int id : m_met) forecast(id, h);  // nothing changes the paths of the other bodies
  }
}

}  // namespace naiad::physics
