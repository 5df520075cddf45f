// The sub-steps of a linkage, and its places.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "physics/geometry/Index.h"
#include "physics/rigid/RigidLinkage.h"

namespace naiad::physics {

namespace {

// Newton's iteration for the places uses the matrix at the start of the sub-step. Its convergence is linear,
// and slow if the sub-step does not resolve the motion.
constexpr int kMaxIterations = 25;
constexpr int kUnchecked = 3;     // number of first iterations whose convergence is not checked
constexpr double kSlowest = 0.4;  // it fails if an error exceeds this fraction of the previous one
constexpr double kSure = 0.1;  // in tolerances: a next error below this, by the present rate, is not computed
constexpr double kStalled = 5;      // in tolerances: an error below this that does not decrease is rounding
constexpr double kDiverged = 1e15;  // metric cells: a double does not resolve a cell beyond it

using Two = double __attribute__((vector_size(16)));

Two twoOf(const Vec2& v) {
  Two two;
  std::memcpy(&two, &v, sizeof two);
  return two;
}

void store(Two two, Vec2& v) {
  v = {two[0], two[1]};
}

}  // namespace

// Finds which ropes and angle limits act: those that pull, and those that the bodies would pass. A taut rope
// does not pull yet if its end only moves across it, because its row is a straight line.
void RigidLinkage::findActive(RigidJoints& joints, double h) {
  const auto mayAct = [](const Link& link) { return isOneSided(link.kind); };
  if (std::none_of(m_links.begin(), m_links.end(), mayAct)) return;
  for (Link& link : m_links) link.is_active = true;
  move(h);
  evaluate<false>(joints);
  for (Link& link : m_links) {
    if (!mayAct(link)) continue;
    const std::span<const RigidRow> rows = joints.rowsOfJoint(link.id);
    link.is_active = !rows.empty() && (rows[0].impulse != 0 || link.side * m_rest[at(link.row[0])] < 0);
  }
  move(0);
}

void RigidLinkage::aim(std::span<RigidState> states, RigidJoints& joints, double h,
                       LinkageCounters& counters) {
  m_kinetic = -1;
  takeStates(states);
  findActive(joints, h);
  if (!m_is_factored) evaluate<true>(*m_p_joints);
  if (errors(h) <= kAimed) return;
  if (!m_is_factored) factor(0);
  std::fill(m_first.begin(), m_first.end(), 0.0);
  if (!solvePlaces(h, counters)) {
    ++counters.missed;
    takeStates(states);
    m_kinetic = motion().kinetic;
    const auto tryAgain = [&](bool is_slowed) {
      takeStates(states);
      if (is_slowed) slowLightNodes();
      std::fill(m_first.begin(), m_first.end(), 0.0);
      return findPlaces(h, kAimed);
    };
    if (!tryAgain(false) && !tryAgain(true)) return;
  }
  giveVelocities(states);
  giveImpulses(m_first, joints);
}

void RigidLinkage::project(std::span<RigidState> states, RigidJoints& joints) {
  takeStates(states);
  if (!m_is_factored) {
    evaluate<true>(joints);
    factor(0);
  }
  m_is_factored = true;
  findSpeedImpulses();
  apply(m_second);
  giveVelocities(states);
  giveImpulses(m_second, joints);
}

void RigidLinkage::giveVelocities(std::span<RigidState> states) const {
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (!isMovable(m_mass[i])) continue;
    states[at(m_nodes[i].body)].velocity = m_nodes[i].velocity;
    states[at(m_nodes[i].body)].spin = m_nodes[i].spin;
  }
}

void RigidLinkage::giveImpulses(const std::vector<double>& impulse, RigidJoints& joints) const {
  for (const Link& link : m_links) {
    const std::span<RigidRow> rows = joints.rowsOfJoint(link.id);
    for (int k = 0; k < link.count && !rows.empty(); ++k) rows[at(k)].impulse += impulse[at(link.row[k])];
  }
}

void RigidLinkage::fit(std::span<RigidState> states) {
  m_is_factored = false;
  takeStates(states);
  if (evaluate<false>(*m_p_joints) <= kAimed) return;
  const auto tryFit = [&] {
    for (Node& node : m_nodes) {
      node.velocity = {};
      node.spin = 0;
    }
    return findPlaces(1, kAimed);
  };
  if (!tryFit()) {
    takeStates(states);
    limitMasses();
    if (!tryFit()) return;
  }
  givePlaces(states);
}

void RigidLinkage::givePlaces(std::span<RigidState> states) const {
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (!isMovable(m_mass[i])) continue;
    states[at(m_nodes[i].body)].displacement = m_nodes[i].displacement;
    states[at(m_nodes[i].body)].turn = m_nodes[i].turn;
  }
}

// Makes heavy bodies lighter, and returns by which factor at most, because impulses that move a very heavy
// body throw its light neighbours far away if the joints are not in line.
double RigidLinkage::limitMasses() {
  constexpr double kMaxRatio = 1000;
  double mass = 0, inertia = 0;
  for (const JointMass& its : m_mass) {
    mass = std::max(mass, its.inverse_mass);
    inertia = std::max(inertia, its.inverse_inertia);
  }
  double most = 1;
  for (JointMass& its : m_mass) {
    if (its.inverse_mass > 0) most = std::max(most, mass / kMaxRatio / its.inverse_mass);
    if (its.inverse_mass > 0) its.inverse_mass = std::max(its.inverse_mass, mass / kMaxRatio);
    if (its.inverse_inertia > 0) its.inverse_inertia = std::max(its.inverse_inertia, inertia / kMaxRatio);
  }
  return most;
}

void RigidLinkage::kick(double h) {
  for (Node& node : m_nodes) {
    node.velocity += h * node.acceleration;
    node.spin += h * node.spin_acceleration;
  }
}

void RigidLinkage::move(double h) {
  for (Node& node : m_nodes) {
    node.displacement = node.displacement_before + h * node.velocity;
    if (m_rods.empty()) node.turn = turned(node.turn_before, h * node.spin);
  }
}

void RigidLinkage::apply(const std::vector<double>& impulse) {
  const double* next = impulse.data();
  if (!m_rods.empty()) return applyToRods(next);
  for (const JointRow& row : m_rows) {
    const double s = *next++;
    Node &a = m_nodes[at(row.a)], &b = m_nodes[at(row.b)];
    const JointMass &of_a = m_mass[at(row.a)], &of_b = m_mass[at(row.b)];
    a.velocity -= (of_a.inverse_mass * s) * row.n;
    a.spin += of_a.inverse_inertia * s * row.ja;
    b.velocity += (of_b.inverse_mass * s) * row.n;
    b.spin += of_b.inverse_inertia * s * row.jb;
  }
}

void RigidLinkage::applyToRods(const double* impulse) {
  for (const JointRow& row : m_rows) {
    const Two push = *impulse++ * twoOf(row.n);
    Vec2 &a = m_nodes[at(row.a)].velocity, &b = m_nodes[at(row.b)].velocity;
    store(twoOf(a) - m_mass[at(row.a)].inverse_mass * push, a);
    store(twoOf(b) + m_mass[at(row.b)].inverse_mass * push, b);
  }
}

void RigidLinkage::addForces(const std::vector<double>& impulse) {
  for (Link& link : m_links) {
    for (int k = 0; k < link.count; ++k) {
      const JointRow& row = m_rows[at(link.row[k])];
      link.force += impulse[at(link.row[k])] * row.n;
      if (k == link.angle_row) link.torque += impulse[at(link.row[k])];
    }
  }
}

double RigidLinkage::speedAlong(const JointRow& row) const {
  const Node &a = m_nodes[at(row.a)], &b = m_nodes[at(row.b)];
  return dot(row.n, b.velocity - a.velocity) + row.jb * b.spin + row.ja * a.spin;
}

void RigidLinkage::factor(double regularisation) {
  m_matrix.factor(m_rows.data(), m_mass.data(), regularisation);
}

// A rod between centres uses (d² − L²) / 2L, which needs no square root and is d − L to first order.
template <bool kJacobian>
double RigidLinkage::evaluate(const RigidJoints& joints) {
  double worst = 0;
  JointFrame frame;
  SpeedRows placed;
  for (Link& link : m_links) {
    const Node &a = m_nodes[at(link.a)], &b = m_nodes[at(link.b)];
    if (!link.is_active) {  // its row has no effect
      m_rest[at(link.row[0])] = 0;
      if constexpr (kJacobian) m_rows[at(link.row[0])] = {{}, 0, 0, link.a, link.b};
      continue;
    }
    if (link.is_rod) {
      const Vec2 offset = link.offset + (b.displacement - a.displacement);
      const double error = (lengthSquared(offset) - link.square) * link.half_inverse_length;
      m_rest[at(link.row[0])] = error;
      worst = std::max(worst, std::fabs(error));
      if (!kJacobian) continue;
      m_rows[at(link.row[0])].n = (2 * link.half_inverse_length) * offset;
      if (!m_rods.empty())
        m_rods[at(link.row[0])] = {offset, link.square, link.half_inverse_length, link.a, link.b};
      continue;
    }
    frame.arm_a = a.turn * link.arm_a;
    frame.arm_b = b.turn * link.arm_b;
    frame.offset = link.offset + (b.displacement - a.displacement) + (frame.arm_b - frame.arm_a);
    if (!kJacobian && link.kind == JointKind::kHinge) {
      m_rest[at(link.row[0])] = frame.offset.x;
      m_rest[at(link.row[1])] = frame.offset.y;
      worst = std::max({worst, std::fabs(frame.offset.x), std::fabs(frame.offset.y)});
      continue;
    }
    frame.axis = a.turn * link.axis;
    frame.between = link.between * (inverse(a.turn) * b.turn);
    placeRows(joints.joint(link.id), frame, placed);
    link.side = placed[0].side;
    for (int k = 0; k < link.count; ++k) {
      const SpeedRow& its = placed[at(k)];
      m_rest[at(link.row[k])] = its.value;
      worst = std::max(worst, std::fabs(its.value));
      if constexpr (kJacobian) m_rows[at(link.row[k])] = {its.n, its.ja, its.jb, link.a, link.b};
    }
  }
  return worst;
}

template double RigidLinkage::evaluate<true>(const RigidJoints& joints);
template double RigidLinkage::evaluate<false>(const RigidJoints& joints);

// Sets m_rest to the errors of rods after the bodies have moved for h. Returns the largest one.
double RigidLinkage::errorsOfRods(double h) {
  double* rest = m_rest.data();
  double worst = 0;
  for (const Rod& rod : m_rods) {
    const Two offset =
        twoOf(rod.offset) + h * (twoOf(m_nodes[at(rod.b)].velocity) - twoOf(m_nodes[at(rod.a)].velocity));
    const Two squares = offset * offset;
    const double error = ((squares[0] + squares[1]) - rod.square) * rod.half_inverse_length;
    worst = std::max(worst, std::fabs(error));
    *rest++ = error;
  }
  return worst;
}

// Moves the bodies for h, and sets m_rest to the errors of the joints. Returns the largest one. If there are
// only rods between centres, the bodies need not be moved.
double RigidLinkage::errors(double h) {
  if (!m_rods.empty()) return errorsOfRods(h);
  move(h);
  return evaluate<false>(*m_p_joints);
}

// Finds the impulses after which the bodies arrive where the joints fit. Returns false if the iteration does
// not converge.
bool RigidLinkage::solvePlaces(double h, LinkageCounters& counters) {
  const double to_impulse = -1 / h;
  double last = kNoLimit;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const double worst = errors(h);
    if (!(worst <= kDiverged)) return false;
    if (worst <= m_tolerance) return true;
    if (iteration >= kUnchecked && worst > kSlowest * last) return worst <= kStalled * m_tolerance;
    ++counters.iterations;
    for (double& rest : m_rest) rest *= to_impulse;
    m_matrix.solve(m_rest.data());
    for (std::size_t i = 0; i < m_rest.size(); ++i) m_first[i] += m_rest[i];
    apply(m_rest);
    if (iteration > 0 && worst * worst <= kSure * m_tolerance * last) return true;
    last = worst;
  }
  return false;
}

// Finds the impulses that remove the speeds along the joints.
void RigidLinkage::findSpeedImpulses() {
  for (std::size_t i = 0; i < m_rows.size(); ++i) m_second[i] = -speedAlong(m_rows[i]);
  m_matrix.solve(m_second.data());
}

void RigidLinkage::projectSpeeds() {
  findSpeedImpulses();
  apply(m_second);
  addForces(m_second);
}

bool RigidLinkage::substep(double h, LinkageCounters& counters) {
  ++counters.substeps;
  for (Node& node : m_nodes) {
    node.displacement_before = node.displacement;
    node.turn_before = node.turn;
  }
  kick(0.5 * h);
  const double ratio = h / m_last_h;
  m_last_h = h;
  for (double& impulse : m_first) impulse *= ratio;
  if (m_is_new) {  // what holds the bodies still if they are at rest
    for (std::size_t i = 0; i < m_rows.size(); ++i) m_first[i] = -speedAlong(m_rows[i]);
    m_matrix.solve(m_first.data());
    m_is_new = false;
  }
  apply(m_first);
  if (!solvePlaces(h, counters)) return false;
  move(h);
  addForces(m_first);
  evaluate<true>(*m_p_joints);
  kick(0.5 * h);
  factor(0);
  projectSpeeds();
  for (Node& node : m_nodes) node.acceleration += node.growth;
  return true;
}

bool RigidLinkage::run(std::span<const double> lengths, LinkageCounters& counters) {
  evaluate<true>(*m_p_joints);
  factor(0);
  projectSpeeds();
  const double kinetic = motion().kinetic;
  for (const double h : lengths) {
    if (!substep(h, counters)) return false;
  }
  if (m_is_conservative) setKinetic(kinetic + work(true), 1 - kEnergyFactor, 1 + kEnergyFactor);
  return true;
}

// Moves the bodies by impulses to the nearest places where the joints fit (Gauss–Newton).
bool RigidLinkage::findPlaces(double h, double tolerance) {
  constexpr double kRegularisation = 1e-9;  // part of the diagonal; makes dependent rows solvable
  constexpr int kRounds = 12;               // limit, rarely reached because convergence is quadratic
  for (int round = 0; round < kRounds; ++round) {
    move(h);
    const double worst = evaluate<true>(*m_p_joints);
    if (worst <= tolerance) return true;
    if (!(worst <= kDiverged)) return false;
    for (double& rest : m_rest) rest /= -h;
    factor(kRegularisation);
    m_matrix.solve(m_rest.data());
    apply(m_rest);
    for (std::size_t i = 0; i < m_rest.size(); ++i) m_first[i] += m_rest[i];
  }
  return false;
}

// Limits the speed of each body to that of the heaviest one and stops all spins, relative to the motion of
// the whole, so that a light chain on a heavy weight does not whirl.
void RigidLinkage::slowLightNodes() {
  const Vec2 whole = motion().velocity;
  double least = kNoLimit, most = 0;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (!(m_mass[i].inverse_mass > 0) || m_mass[i].inverse_mass >= least) continue;
    least = m_mass[i].inverse_mass;
    most = length(m_nodes[i].velocity - whole);
  }
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Vec2& velocity = m_nodes[i].velocity;
    const double speed = length(velocity - whole);
    if (m_mass[i].inverse_mass > 0 && speed > most) velocity = whole + (most / speed) * (velocity - whole);
    if (m_mass[i].inverse_inertia > 0) m_nodes[i].spin = 0;
  }
}

// A sub-step that is bounded, but not exact. The bodies fly, then move to the nearest places where the joints
// fit (fast projection: Goldenthal et al. 2007). This is in effect backward Euler, which damps what the
// sub-step does not resolve. If there are no such places, slows light bodies, and at last lets the linkage
// move as a whole.
void RigidLinkage::approximate(double h) {
  const Motion before = motion();
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Node& node = m_nodes[i];
    node.displacement_before = node.displacement;
    node.turn_before = node.turn;
    m_velocity_before[i] = node.velocity;
    m_spin_before[i] = node.spin;
  }
  const auto start = [&] {
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      m_nodes[i].velocity = m_velocity_before[i];
      m_nodes[i].spin = m_spin_before[i];
    }
    std::fill(m_first.begin(), m_first.end(), 0.0);
    kick(h);
  };
  start();
  bool is_found = findPlaces(h, kAimed);
  if (!is_found) {
    start();
    slowLightNodes();
    is_found = findPlaces(h, kAimed);
  }
  if (!is_found) {
    start();
    const Vec2 whole = motion().velocity;
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      if (m_mass[i].inverse_mass > 0) m_nodes[i].velocity = whole;
      if (m_mass[i].inverse_inertia > 0) m_nodes[i].spin = 0;
    }
    std::fill(m_first.begin(), m_first.end(), 0.0);
    move(h);
    evaluate<true>(*m_p_joints);
  }
  addForces(m_first);
  factor(1e-9);
  projectSpeeds();
  setKinetic(std::max(0.0, before.kinetic + work(false)), 0, 1);
  for (Node& node : m_nodes) node.acceleration += node.growth;
}

}  // namespace naiad::physics
