#include "physics/joint/JointImpacts.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"
#include "physics/numerics/PolynomialRoots.h"

namespace naiad::physics {

namespace {

constexpr double kDeepest = 1e-6;  // fraction of the reach: limit of the overlap at the start
constexpr double kTouch = 1e-9;    // metric cells: a gap below this counts as touching
constexpr double kSink =
    1e-11;  // metric cells: rounding of the places, by which a pair may come nearer without an impact
constexpr double kRestSpeed = 1e-9;  // metric cells per unit of time: slower approaches do not bounce
constexpr double kInstant = 1e-9;    // units of time: impacts within this time are simultaneous
constexpr double kFound = 1e-13;     // metric cells: Newton's method ends when the gap is smaller
constexpr int kTries = 8;  // limit of Newton iterations for a moment, and of flights in a row without time
// A step with more than kMaxImpacts + kMaxPerPair · pairs impacts is abandoned: the RigidWorld moves it.
constexpr int kMaxImpacts = 256;
constexpr int kMaxPerPair = 16;

Vec2 offsetOf(const JointPair& pair, std::span<const JointBody> bodies) {
  return bodies[at(pair.b)].place - bodies[at(pair.a)].place;
}

Vec2 speedOf(const JointPair& pair, std::span<const JointBody> bodies) {
  return bodies[at(pair.b)].velocity - bodies[at(pair.a)].velocity;
}

double gapOf(const JointPair& pair, std::span<const JointBody> bodies) {
  return length(offsetOf(pair, bodies)) - pair.reach;
}

Vec2 normalOf(const JointPair& pair, std::span<const JointBody> bodies) {
  const Vec2 offset = offsetOf(pair, bodies);
  const double distance = length(offset);
  return distance > 0 ? offset / distance : Vec2{1, 0};
}

double approachOf(const JointPair& pair, std::span<const JointBody> bodies) {
  return -dot(normalOf(pair, bodies), speedOf(pair, bodies));
}

// Returns when the displacement between two bodies first becomes shorter than `least`; −1 if it never does.
// The displacement is a cubic of time from 0 to 1, with these values and rates at both ends.
double firstWithin(double least, Vec2 from, Vec2 from_rate, Vec2 to, Vec2 to_rate) {
  const Vec2 bend = 3 * (to - from) - 2 * from_rate - to_rate;
  const Vec2 rest = from_rate + to_rate - 2 * (to - from);
  const double square[] = {lengthSquared(from) - least * least,
                           2 * dot(from, from_rate),
                           lengthSquared(from_rate) + 2 * dot(from, bend),
                           2 * (dot(from, rest) + dot(from_rate, bend)),
                           lengthSquared(bend) + 2 * dot(from_rate, rest),
                           2 * dot(bend, rest),
                           lengthSquared(rest)};
  return firstBelowZero(square, 6, 0, 1);
}

}  // namespace

// Collects the bodies, joints and islands that take part. Returns false if the method is not possible.
bool JointImpacts::gather(std::span<const JointBody> bodies, std::span<const Joint> joints) {
  m_islands.clear();
  m_bodies.clear();
  m_free.clear();
  m_joints.clear();
  for (const JointPair& pair : m_pairs) {
    for (const int body : {pair.a, pair.b}) {
      const int island = m_solver->islandOf(body);
      (island >= 0 ? m_islands : m_free).push_back(island >= 0 ? island : body);
    }
  }
  for (auto* list : {&m_islands, &m_free}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  m_bodies = m_free;
  for (const int island : m_islands) {
    const JointIsland& its = m_solver->islands()[at(island)];
    if (its.isFrozen() || !its.isTwoSided()) return false;
    m_bodies.insert(m_bodies.end(), its.bodies().begin(), its.bodies().end());
    its.appendJoints(m_joints);
  }
  for (const int joint : m_joints) {
    if (joints[at(joint)].kind == JointKind::kMouse) return false;
  }
  std::sort(m_bodies.begin(), m_bodies.end());
  m_bodies.erase(std::unique(m_bodies.begin(), m_bodies.end()), m_bodies.end());
  return std::all_of(m_bodies.begin(), m_bodies.end(), [&](int body) {
    const JointBody& its = bodies[at(body)];
    return isMovable(its) || (its.velocity == Vec2{} && its.spin == 0);
  });
}

void JointImpacts::save(std::span<const JointBody> bodies) {
  m_before.clear();
  for (const int body : m_bodies) m_before.push_back(bodies[at(body)]);
}

void JointImpacts::restore(std::span<JointBody> bodies) const {
  for (std::size_t i = 0; i < m_bodies.size(); ++i) bodies[at(m_bodies[i])] = m_before[i];
}

void JointImpacts::fly(std::span<JointBody> bodies, std::span<Joint> joints, double h) {
  for (const int island : m_islands) m_solver->stepIsland(island, bodies, joints, h, {});
  for (const int index : m_free) {
    JointBody& body = bodies[at(index)];
    const Vec2 gained = (h * body.inverse_mass) * body.force;
    body.place = body.place + h * (body.velocity + 0.5 * gained);
    body.velocity += gained;
  }
}

// Returns the pair that touches first between m_before and the present places; −1 if no pair does.
int JointImpacts::findImpact(std::span<const JointBody> bodies, double left, double& time) const {
  const auto before = [&](int body) -> const JointBody& {
    const auto found = std::lower_bound(m_bodies.begin(), m_bodies.end(), body);
    return m_before[static_cast<std::size_t>(found - m_bodies.begin())];
  };
  int first = -1;
  double first_time = 2;
  for (int i = 0; i < static_cast<int>(m_pairs.size()); ++i) {
    const JointPair& pair = m_pairs[at(i)];
    const JointBody &a = before(pair.a), &b = before(pair.b);
    const Vec2 from = b.place - a.place, rate = left * (b.velocity - a.velocity);
    const Vec2 to = offsetOf(pair, bodies), to_rate = left * speedOf(pair, bodies);
    const double travel = length(to - from) + length(rate) + length(to_rate);
    const double radius = pair.reach + m_floor[at(i)] - kSink;
    if (length(from) - travel > radius) continue;
    const double crossing = firstWithin(radius, from, rate, to, to_rate);
    if (crossing < 0 || crossing >= first_time) continue;
    first_time = crossing;
    first = i;
  }
  time = first_time * left;
  return first;
}

// Corrects the moment of an impact by Newton's method, because the bodies' paths are not exactly cubic. Moves
// the bodies to that moment. Returns false if they overlap there.
bool JointImpacts::refineImpact(int pair, std::span<JointBody> bodies, std::span<Joint> joints, double left,
                                double& time) {
  const JointPair& its = m_pairs[at(pair)];
  double gap = 0;
  for (int i = 0; i < kTries; ++i) {
    restore(bodies);
    if (time < kInstant) {
      time = 0;
      return true;
    }
    fly(bodies, joints, time);
    gap = gapOf(its, bodies) - m_floor[at(pair)];
    const double closing = approachOf(its, bodies);
    if (std::abs(gap) <= kFound || !(closing > kRestSpeed)) break;
    const double next = std::clamp(time + gap / closing, 0.0, left);
    if (next == time) break;
    time = next;
  }
  return gap > -kTouch;
}

// Returns the speed at which the two bodies separate along `direction` after a unit impulse: the inverse
// effective mass of the pair with its joints. Sets m_change to the change of each body.
double JointImpacts::inverseEffectiveMass(const JointPair& pair, Vec2 direction, std::span<JointBody> bodies,
                                          std::span<Joint> joints) {
  m_responding.clear();
  const auto localOf = [&](int body) {
    return static_cast<int>(std::lower_bound(m_bodies.begin(), m_bodies.end(), body) - m_bodies.begin());
  };
  const int islands[] = {m_solver->islandOf(pair.a), m_solver->islandOf(pair.b)};
  const bool is_same = islands[0] >= 0 && islands[0] == islands[1];
  for (int k = 0; k < 2; ++k) {
    if (islands[k] < 0) m_responding.push_back(localOf(k == 0 ? pair.a : pair.b));
    if (islands[k] < 0 || (k == 1 && is_same)) continue;
    for (const int body : m_solver->islands()[at(islands[k])].bodies()) {
      if (isMovable(bodies[at(body)])) m_responding.push_back(localOf(body));
    }
  }
  m_change.resize(m_bodies.size());
  for (const int local : m_responding) {
    JointBody& body = bodies[at(m_bodies[at(local)])];
    m_change[at(local)] = {body.velocity, body.spin};
    body.velocity = {};
    body.spin = 0;
  }
  JointBody &a = bodies[at(pair.a)], &b = bodies[at(pair.b)];
  a.velocity -= a.inverse_mass * direction;
  b.velocity += b.inverse_mass * direction;
  for (int k = 0; k < 2; ++k) {
    if (islands[k] >= 0 && !(k == 1 && is_same)) m_solver->holdIsland(islands[k], bodies, joints);
  }
  const double parting = dot(direction, b.velocity - a.velocity);
  for (const int local : m_responding) {
    JointBody& body = bodies[at(m_bodies[at(local)])];
    std::swap(body.velocity, m_change[at(local)].velocity);
    std::swap(body.spin, m_change[at(local)].spin);
  }
  return parting;
}

void JointImpacts::applyImpulse(double impulse, std::span<JointBody> bodies) const {
  for (const int local : m_responding) {
    JointBody& body = bodies[at(m_bodies[at(local)])];
    body.velocity += impulse * m_change[at(local)].velocity;
    body.spin += impulse * m_change[at(local)].spin;
  }
}

void JointImpacts::resolveImpact(int index, std::span<JointBody> bodies, std::span<Joint> joints,
                                 double now) {
  const JointPair& pair = m_pairs[at(index)];
  const Vec2 normal = normalOf(pair, bodies), tangent = perpendicular(normal);
  const double approach = -dot(normal, speedOf(pair, bodies));
  const double parting = inverseEffectiveMass(pair, normal, bodies, joints);
  if (!(parting > 0)) return;
  const double restitution = approach > kRestSpeed ? pair.restitution : 0;
  const double impulse = (1 + restitution) * approach / parting;
  applyImpulse(impulse, bodies);
  m_impacts.push_back({now, index, impulse});
  if (pair.friction == 0) return;
  const double slip = dot(tangent, speedOf(pair, bodies));
  const double sliding = slip == 0 ? 0 : inverseEffectiveMass(pair, tangent, bodies, joints);
  if (!(sliding > 0)) return;
  const double most = pair.friction * impulse;
  applyImpulse(std::clamp(-slip / sliding, -most, most), bodies);
}

// Resolves all impacts of one moment, the fastest first. The pair `forced` has an impact even if it is slow.
// Returns false if there are too many impacts.
bool JointImpacts::resolveImpacts(std::span<JointBody> bodies, std::span<Joint> joints, double now,
                                  int forced) {
  const std::size_t most = kMaxImpacts + kMaxPerPair * m_pairs.size();
  while (m_impacts.size() <= most) {
    int hardest = -1;
    double greatest = kRestSpeed;
    for (int i = 0; i < static_cast<int>(m_pairs.size()); ++i) {
      if (i != forced && gapOf(m_pairs[at(i)], bodies) > m_floor[at(i)] + kTouch) continue;
      const double approach = approachOf(m_pairs[at(i)], bodies);
      if (!(approach > greatest)) continue;
      greatest = approach;
      hardest = i;
    }
    if (hardest < 0 && forced >= 0 && approachOf(m_pairs[at(forced)], bodies) > 0) hardest = forced;
    if (hardest < 0) return true;
    resolveImpact(hardest, bodies, joints, now);
    forced = hardest == forced ? -1 : forced;
  }
  return false;
}

bool JointImpacts::run(std::span<JointBody> bodies, std::span<Joint> joints, double h) {
  double now = 0;
  int at_once = 0;  // number of consecutive flights that took no time
  if (!resolveImpacts(bodies, joints, 0, -1)) return false;
  while (h - now > kInstant) {
    const double left = h - now;
    double flown = left;
    save(bodies);
    fly(bodies, joints, left);
    const int pair = findImpact(bodies, left, flown);
    if (pair < 0) flown = left;
    if (pair >= 0 && !refineImpact(pair, bodies, joints, left, flown)) return false;
    if (flown > 0) {
      for (std::size_t i = 0; i < m_joints.size(); ++i) {
        m_force[i] += flown * joints[at(m_joints[i])].force;
        m_torque[i] += flown * joints[at(m_joints[i])].torque;
      }
    }
    now += flown;
    if (pair < 0) break;
    at_once = flown > 0 ? 0 : at_once + 1;
    if (at_once > kTries || !resolveImpacts(bodies, joints, now, pair)) return false;
  }
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    joints[at(m_joints[i])].force = m_force[i] / h;
    joints[at(m_joints[i])].torque = m_torque[i] / h;
  }
  return true;
}

bool JointImpacts::step(JointSolver& solver, std::span<JointBody> bodies, std::span<Joint> joints,
                        std::span<const JointPair> pairs, double h) {
  m_solver = &solver;
  m_pairs = pairs;
  m_impacts.clear();
  if (!gather(bodies, joints)) return false;
  m_floor.clear();
  for (const JointPair& pair : pairs) {
    const double gap = gapOf(pair, bodies);
    if (!(gap > -kDeepest * pair.reach)) return false;
    m_floor.push_back(std::min(gap, 0.0));
  }
  m_force.assign(m_joints.size(), {});
  m_torque.assign(m_joints.size(), 0);
  save(bodies);
  m_first = m_before;
  if (run(bodies, joints, h)) return true;
  undo(bodies);
  return false;
}

void JointImpacts::undo(std::span<JointBody> bodies) {
  m_before = m_first;
  restore(bodies);
  m_impacts.clear();
}

}  // namespace naiad::physics
