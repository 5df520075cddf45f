// Impacts of joined bodies, at their times within a sub-step: all bodies of a linkage respond at once.
#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"
#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

constexpr int kBounceRounds = 16;  // bounces of the points of an impact in turn, before they end at rest
constexpr int kBounceSweeps = 32;  // maximum sweeps over the points of an impact
constexpr double kBounceRounding = 1e-14;  // part of the speeds
constexpr double kShort = 0.01;            // part of a sub-step in which the forces of joints may be wrong

double rowSpeed(const ImpactRow& row, const Vec2& velocity_a, double spin_a, const Vec2& velocity_b,
                double spin_b) {
  return dot(row.n, velocity_b - velocity_a) + (row.lever_b * spin_b - row.lever_a * spin_a);
}

// Finds the impulses of an impact. Each normal that approaches leaves with restitution × its speed, or is
// pushed by the other. This is repeated for what approaches then. Returns true if a point comes to rest.
bool findImpulses(std::span<ImpactRow> rows, std::size_t normals, double restitution, double friction,
                  double rest_speed, double rest_after, double rounding) {
  bool rests = false;
  const auto give = [&](std::size_t i, double more) {
    rows[i].impulse += more;
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].speed += more * rows[i].gain[k];
    return std::fabs(more) * rows[i].gain[i];
  };
  for (int round = 0; round <= kBounceRounds; ++round) {
    const double e = round < kBounceRounds || restitution == 1 ? restitution : 0;
    std::array<double, 2> target = {}, before = {};
    std::array<bool, 2> is_met = {};
    for (std::size_t i = 0; i < normals; ++i) {
      const double speed = -rows[i].speed;
      is_met[i] = speed > rounding;
      target[i] = e * speed > rest_speed ? e * speed : rest_after;
      rests = rests || (is_met[i] && !(e * speed > rest_speed));
      before[i] = rows[i].impulse;
    }
    if (!is_met[0] && !is_met[1]) break;
    for (int sweep = 0; sweep < kBounceSweeps; ++sweep) {
      double change = 0;
      for (std::size_t i = 0; i < normals; ++i) {
        ImpactRow& row = rows[i];
        if (!is_met[i] || !(row.gain[i] > 0)) continue;
        const double wanted = row.impulse + (target[i] - row.speed) / row.gain[i];
        change = std::max(change, give(i, std::max(wanted, before[i]) - row.impulse));
      }
      for (std::size_t i = normals; i < rows.size(); ++i) {
        ImpactRow& row = rows[i];
        if (!(row.gain[i] > 0)) continue;
        const double most = friction * rows[i - normals].impulse;
        const double wanted = std::clamp(row.impulse - row.speed / row.gain[i], -most, most);
        change = std::max(change, give(i, wanted - row.impulse));
      }
      if (change <= rounding) break;
    }
  }
  return rests;
}

}  // namespace

void RigidLinkage::meet(std::span<RigidState> states) {
  takeStates(states);
  evaluate<true>(*m_p_joints);
  factor(0);
  findSpeedImpulses();
  apply(m_second);
  giveVelocities(states);
  for (Node& node : m_nodes) node.velocity = {}, node.spin = 0;
}

void RigidLinkage::push(int body, Vec2 impulse, double turning) {
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (m_nodes[i].body != body) continue;
    m_nodes[i].velocity += m_mass[i].inverse_mass * impulse;
    m_nodes[i].spin += m_mass[i].inverse_inertia * turning;
  }
}

void RigidLinkage::respond(std::vector<BodyChange>& changes) {
  findSpeedImpulses();
  apply(m_second);
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Node& node = m_nodes[i];
    if (isMovable(m_mass[i])) changes.push_back({node.body, node.velocity, node.spin});
    node.velocity = {};
    node.spin = 0;
  }
}

void RigidLinkage::addImpact(RigidJoints& joints) const {
  for (const Link& link : m_links) {
    Vec2 force;
    double torque = 0;
    for (int k = 0; k < link.count; ++k) {
      const double impulse = m_second[at(link.row[k])];
      force += impulse * m_rows[at(link.row[k])].n;
      if (k == link.angle_row) torque += impulse;
    }
    joints.addImpact(link.id, force, torque);
  }
}

void RigidLinkage::lead(std::span<RigidState> states, double h, LinkageCounters& counters) {
  takeStates(states);
  std::fill(m_first.begin(), m_first.end(), 0.0);
  if (!solvePlaces(h, counters)) return;
  giveVelocities(states);
}

// Lists in m_met the movable bodies whose paths an impact of the two bodies changes, and moves them to the
// time of the impact.
void RigidWorld::gatherMet(int a, int b, double time, double h) {
  m_met.clear();
  for (const int id : {a, b}) {
    const int index = flyingLinkageOf(id);
    if (index < 0) {
      if (isMovable(id)) m_met.push_back(id);
      continue;
    }
    if (id == b && index == flyingLinkageOf(a)) continue;
    RigidLinkage& linkage = m_linkages[at(index)];
    if (!linkage.isBegun()) {  // it slept
      linkage.visitBodies([&](int body) { wakeInFlight(body); });
      linkage.begin(m_bodies, m_states, m_joints);
    }
    linkage.visitBodies([&](int body) {
      addFlight(body, 0);
      Flight& flight = m_flights[at(m_extras[at(body)].flight)];
      flight.impacts = std::max(flight.impacts, 1);
      if (!flight.is_held) advance(body, time, h);
      if (isMovable(body)) m_met.push_back(body);
    });
  }
}

// Finds how the bodies respond to a unit impulse along the row.
void RigidWorld::findResponse(const ContactConstraint& c, ImpactRow& row) {
  row.changes.clear();
  row.impulse = 0;
  const int linkage_a = flyingLinkageOf(c.a), linkage_b = flyingLinkageOf(c.b);
  const auto push = [&](int linkage, int id, double sign, double lever) {
    const RigidState& s = m_states[at(id)];
    if (linkage >= 0) {
      m_linkages[at(linkage)].push(id, sign * row.n, sign * lever);
    } else if (isMovable(id)) {
      row.changes.push_back({id, (sign * s.inverse_mass) * row.n, sign * s.inverse_inertia * lever});
    }
  };
  push(linkage_a, c.a, -1, row.lever_a);
  push(linkage_b, c.b, 1, row.lever_b);
  if (linkage_a >= 0) m_linkages[at(linkage_a)].respond(row.changes);
  if (linkage_b >= 0 && linkage_b != linkage_a) m_linkages[at(linkage_b)].respond(row.changes);
}

// Like applyImpact(), for bodies of linkages. Their paths between impacts are parabolas, too. The impact
// divides the sub-step into two of RATTLE: one ends with the places and velocities before it, the other
// starts after.
void RigidWorld::applyJoinedImpact(ContactConstraint& c, double time, double h) {
  const double since = 2 * time - 1, left = 1 - time;
  const auto flightOf = [&](int id) -> Flight& { return m_flights[at(m_extras[at(id)].flight)]; };
  for (const int id : m_met) {
    RigidState& s = m_states[at(id)];
    const Flight& flight = flightOf(id);
    if (flyingLinkageOf(id) >= 0 && flight.bend != Vec2{}) {
      s.velocity += (time + flight.last - 1) * flight.bend + (time - flight.last) * s.kick;
    } else {
      s.velocity += since * flight.bend;
    }
    s.spin += since * flight.spin_bend;
  }
  const std::array<int, 2> both = {flyingLinkageOf(c.a), flyingLinkageOf(c.b)};
  const std::span<const int> linkages = std::span(both).first(both[0] == both[1] ? 1 : 2);
  for (const int linkage : linkages) {
    if (linkage >= 0) m_linkages[at(linkage)].meet(m_states);
  }
  const std::size_t normals = at(c.count), count = c.friction > 0 ? 2 * normals : normals;
  const std::span<ImpactRow> rows = std::span(m_impact_rows).first(count);
  const RigidState &a = m_states[at(c.a)], &b = m_states[at(c.b)];
  double rounding = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ContactPoint& p = c.points[i % normals];
    ImpactRow& row = rows[i];
    row.n = i < normals ? c.normal : perpendicular(c.normal);
    row.lever_a = i < normals ? p.normal_a : p.tangent_a;
    row.lever_b = i < normals ? p.normal_b : p.tangent_b;
    row.speed = rowSpeed(row, a.velocity, a.spin, b.velocity, b.spin);
    rounding = std::max(rounding, length(a.velocity) + length(b.velocity) + std::fabs(row.lever_a * a.spin) +
                                      std::fabs(row.lever_b * b.spin));
    findResponse(c, row);
  }
  rounding *= kBounceRounding;
  double along = 0;
  for (ImpactRow& row : rows) {
    BodyChange of_a, of_b;
    for (const BodyChange& change : row.changes) {
      if (change.body == c.a) of_a = change;
      if (change.body == c.b) of_b = change;
    }
    for (std::size_t k = 0; k < count; ++k)
      row.gain[k] = rowSpeed(rows[k], of_a.velocity, of_a.spin, of_b.velocity, of_b.spin);
  }
  std::array<double, 4> before = {};
  for (std::size_t i = 0; i < count; ++i) before[i] = rows[i].speed;
  const double rest_after = since * dot(c.normal, bendOf(c.b) - bendOf(c.a));
  const bool rests =
      findImpulses(rows, normals, c.restitution, c.friction, restSpeed(c, m_states), rest_after, rounding);
  double square = 0;  // the impulses change the energy by along + square
  for (std::size_t i = 0; i < count; ++i) {
    along += rows[i].impulse * before[i];
    square += 0.5 * rows[i].impulse * (rows[i].speed - before[i]);
  }
  const double part = c.friction > 0 && along + square > 0 ? std::clamp(-along / square, 0.0, 1.0) : 1;
  for (std::size_t i = 0; i < count; ++i) {
    for (const BodyChange& change : rows[i].changes) {
      m_states[at(change.body)].velocity += (part * rows[i].impulse) * change.velocity;
      m_states[at(change.body)].spin += part * rows[i].impulse * change.spin;
    }
    if (i < normals) c.points[i].total += part * rows[i].impulse;
  }
  for (const int linkage : linkages) {  // for the forces of joints
    if (linkage < 0) continue;
    RigidLinkage& its = m_linkages[at(linkage)];
    for (const ImpactRow& row : rows) {
      const double impulse = part * row.impulse;
      if (linkage == both[0]) its.push(c.a, -impulse * row.n, -impulse * row.lever_a);
      if (linkage == both[1]) its.push(c.b, impulse * row.n, impulse * row.lever_b);
    }
    m_impact_rows[0].changes.clear();
    its.respond(m_impact_rows[0].changes);
    its.addImpact(m_joints);
  }
  c.is_ballistic = c.restitution > 0 && c.may_fly && !rests;
  // Bodies that rest on each other do not fall in the rest of the sub-step, unless they fall together.
  const bool presses = dot(c.normal, m_states[at(c.b)].kick - m_states[at(c.a)].kick) < 0;
  for (const int id : {c.a, c.b}) {
    if (rests && presses) flightOf(id).bend = {};
  }
  m_met_velocities.clear();
  for (const int id : m_met) {
    RigidState& s = m_states[at(id)];
    m_met_velocities.push_back(s.velocity);
    s.velocity +=
        left * (flyingLinkageOf(id) >= 0 && flightOf(id).bend != Vec2{} ? s.kick : flightOf(id).bend);
    s.spin += left * flightOf(id).spin_bend;
  }
  for (const int linkage : linkages) {
    if (linkage >= 0 && left >= kShort) m_linkages[at(linkage)].lead(m_states, left * h, m_linkage_counters);
  }
  for (std::size_t i = 0; i < m_met.size(); ++i) {
    RigidState& s = m_states[at(m_met[i])];
    Flight& flight = flightOf(m_met[i]);
    if (left >= kShort && flyingLinkageOf(m_met[i]) >= 0)
      flight.bend = (s.velocity - m_met_velocities[i]) / left;
    s.velocity = m_met_velocities[i] - since * flight.bend;
    s.spin -= time * s.spin_kick;
    flight.spin_bend = s.spin_kick;
    flight.last = time;
  }
}

}  // namespace naiad::physics
