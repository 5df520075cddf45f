#include "physics/rigid/RigidLinkage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr int kLeastSubsteps = 4, kMostSubsteps = 32;  // in a tick
constexpr double kLargestTurn = 0.7;                   // rad by which a joint's force may turn in a sub-step
// A composition of five sub-steps, one of them backwards, is of order 4 (Suzuki 1990). It is used if forces
// turn by at most kCalm rad in a tick; otherwise equal sub-steps are better.
constexpr double kCalm = 0.5;
constexpr double kOuter = 0.41449077179437574, kInner = 1 - 4 * kOuter;
constexpr std::array<double, 5> kComposed = {kOuter, kOuter, kInner, kOuter, kOuter};

std::array<double, kMostSubsteps> equalLengths(int substeps) {
  std::array<double, kMostSubsteps> lengths;
  lengths.fill(1.0 / substeps);
  return lengths;
}

}  // namespace

bool RigidLinkage::canBeAlone(const Joint& joint) {
  return joint.kind == JointKind::kDistance || joint.kind == JointKind::kHinge ||
         joint.kind == JointKind::kWeld || joint.kind == JointKind::kSlider;
}

std::vector<std::int64_t> RigidLinkage::keyOf(std::span<const int> ids, const JointStore& store,
                                              std::span<const RigidBody> bodies) {
  std::vector<std::int64_t> key;
  const auto addBody = [&](int body, Vec2 anchor) {
    const RigidBody& its = bodies[at(body)];
    key.push_back(body);
    key.push_back((its.inverse_mass > 0 ? 1 : 0) + (its.inverse_inertia > 0 ? 2 : 0) +
                  (anchor == Vec2{} ? 4 : 0));
  };
  for (const int id : ids) {
    const Joint& joint = store.joint(id);
    key.push_back(id);
    key.push_back(static_cast<std::int64_t>(joint.kind));
    if (JointStore::firstOf(joint) >= 0) addBody(joint.a, joint.anchor_a);
    addBody(joint.b, joint.anchor_b);
  }
  return key;
}

RigidLinkage::RigidLinkage(std::span<const int> ids, const JointStore& store,
                           std::span<const RigidBody> bodies)
    : m_key(keyOf(ids, store, bodies)) {
  const auto nodeOf = [&](int body) {
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      if (m_nodes[i].body == body) return static_cast<int>(i);
    }
    m_nodes.push_back({});
    m_nodes.back().body = body;
    m_mass.push_back({bodies[at(body)].inverse_mass, bodies[at(body)].inverse_inertia});
    return static_cast<int>(m_nodes.size()) - 1;
  };
  bool is_rods = true;
  for (const int id : ids) {
    const Joint& joint = store.joint(id);
    if (!canHave(joint)) {
      const int a = JointStore::firstOf(joint);
      if (a >= 0) nodeOf(a);
      nodeOf(joint.b);
      m_springs.push_back({id, a, joint.b});
      m_has_motor = m_has_motor || joint.kind == JointKind::kMotor;
      continue;
    }
    Link link = {};
    link.id = id;
    link.kind = joint.kind;
    link.a = nodeOf(joint.a);
    link.b = nodeOf(joint.b);
    link.is_active = true;
    link.side = joint.kind == JointKind::kRope ? -1 : 0;
    link.is_rod = (joint.kind == JointKind::kDistance || joint.kind == JointKind::kRope) &&
                  joint.anchor_a == Vec2{} && joint.anchor_b == Vec2{};
    const bool may_turn = m_mass[at(link.a)].inverse_inertia > 0 || m_mass[at(link.b)].inverse_inertia > 0;
    const auto follows = [&](int node, Vec2 anchor) {
      return m_mass[at(node)].inverse_inertia > 0 || (joint.kind == JointKind::kDistance && anchor == Vec2{});
    };
    link.may_rotate = follows(link.a, joint.anchor_a) && follows(link.b, joint.anchor_b);
    const int rows = rowsOf(joint);
    link.angle_row = -1;
    for (int k = 0; k < rows; ++k) {
      if (isAngleRow(joint.kind, k) && !may_turn) continue;
      if (isAngleRow(joint.kind, k)) link.angle_row = k;
      link.row[link.count++] = static_cast<int>(m_rows.size());
      m_rows.push_back({{}, 0, 0, link.a, link.b});
    }
    is_rods = is_rods && link.is_rod && joint.kind == JointKind::kDistance;
    if (link.count == 0) {  // an angle limit of bodies that do not turn
      m_springs.push_back({id, joint.a, joint.b});
    } else {
      m_links.push_back(link);
    }
  }
  m_is_free = true;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (isMovable(m_mass[i])) {
      m_some_body = m_nodes[i].body;
    } else {
      m_is_free = false;
    }
    is_rods = is_rods && m_mass[i].inverse_inertia == 0;
  }
  m_may_rotate = m_is_free && std::all_of(m_links.begin(), m_links.end(),
                                          [](const Link& link) { return link.may_rotate; });
  const std::vector<int> order = eliminationOrder(m_rows, m_mass);
  std::vector<int> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[at(order[i])] = static_cast<int>(i);
  const std::vector<JointRow> unsorted = m_rows;
  for (std::size_t i = 0; i < unsorted.size(); ++i) m_rows[at(rank[i])] = unsorted[i];
  for (Link& link : m_links) {
    for (int k = 0; k < link.count; ++k) link.row[k] = rank[at(link.row[k])];
  }
  m_matrix.analyse(m_rows, m_mass);
  for (auto* list : {&m_first, &m_second, &m_rest}) list->assign(m_rows.size(), 0);
  if (is_rods && m_springs.empty()) m_rods.resize(m_rows.size());
  m_velocity_before.resize(m_nodes.size());
  m_spin_before.resize(m_nodes.size());
}

void RigidLinkage::load(std::span<const RigidBody> bodies, const RigidJoints& joints, int substeps) {
  const double h = 1.0 / substeps;
  m_last_h = h;
  const Place& first = bodies[at(m_nodes[0].body)].place;
  m_is_conservative = true;
  double extent = 1;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Node& node = m_nodes[i];
    const RigidBody& body = bodies[at(node.body)];
    m_mass[i] = {body.inverse_mass, body.inverse_inertia};
    node.velocity = body.velocity;
    node.spin = body.spin;
    node.displacement = {};
    node.turn = {};
    node.origin = body.place - first;
    extent = std::max({extent, std::fabs(node.origin.x), std::fabs(node.origin.y)});
    RigidState state;
    if (body.inverse_mass > 0) setKick(state, body.acceleration, body.jerk, h, substeps);
    node.acceleration = (2 / h) * state.kick;
    node.growth = (2 / h) * state.kick_growth;
    node.spin_acceleration = body.inverse_inertia * body.torque;
    const bool is_driven = !isMovable(m_mass[i]) && (body.velocity != Vec2{} || body.spin != 0);
    if (is_driven || node.spin_acceleration != 0 || node.growth != Vec2{}) m_is_conservative = false;
  }
  m_tolerance = std::max(kTolerance, 0x1p-50 * extent);
  loadLinks(bodies, joints);
  m_is_new = true;
  for (Link& link : m_links) {
    link.force = {};
    link.torque = 0;
    const JointStore::Memory& memory = joints.memoryOf(link.id);
    for (int k = 0; k < link.count; ++k) {
      m_first[at(link.row[k])] = 0.5 * h * memory[at(k)];
      m_is_new = m_is_new && memory[at(k)] == 0;
    }
  }
}

void RigidLinkage::loadLinks(std::span<const RigidBody> bodies, const RigidJoints& joints) {
  m_p_joints = &joints;
  for (Link& link : m_links) {
    const Joint& joint = joints.joint(link.id);
    const RigidBody &a = bodies[at(m_nodes[at(link.a)].body)], &b = bodies[at(m_nodes[at(link.b)].body)];
    link.offset = b.place - a.place;
    link.arm_a = a.rotation * joint.anchor_a;
    link.arm_b = b.rotation * joint.anchor_b;
    link.axis = a.rotation * joint.axis;
    link.between = inverse(joint.reference) * (inverse(a.rotation) * b.rotation);
    link.square = joint.length * joint.length;
    link.half_inverse_length = joint.length > 0 ? 0.5 / joint.length : 0;
  }
}

void RigidLinkage::begin(std::span<const RigidBody> bodies, std::span<const RigidState> states,
                         const RigidJoints& joints) {
  m_is_begun = true;
  m_is_factored = false;
  loadLinks(bodies, joints);
  m_tolerance = kTolerance;
  takeStates(states);
  m_start_energy = motion().kinetic + springEnergy(bodies, states);
}

void RigidLinkage::takeStates(std::span<const RigidState> states) {
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Node& node = m_nodes[i];
    const RigidState& state = states[at(node.body)];
    m_mass[i] = {state.inverse_mass, state.inverse_inertia};
    node.velocity = state.velocity;
    node.spin = state.spin;
    node.displacement = node.displacement_before = state.displacement;
    node.turn = node.turn_before = state.turn;
  }
}

// Returns the greatest rate, in radians per tick, at which a joint's force turns, or would turn if it were
// disturbed: the frequency of a pendulum, or of a taut string.
double RigidLinkage::rateOf(std::span<const RigidBody> bodies, const RigidJoints& joints) const {
  double square = 0;
  for (const Link& link : m_links) {
    const Joint& joint = joints.joint(link.id);
    const RigidBody &a = bodies[at(m_nodes[at(link.a)].body)], &b = bodies[at(m_nodes[at(link.b)].body)];
    const double arm_a = length(joint.anchor_a), arm_b = length(joint.anchor_b);
    const double lever = joint.length > 0 ? joint.length : std::max(arm_a, arm_b);
    if (!(lever > 0)) continue;
    const double inverse_mass = a.inverse_mass + b.inverse_mass + a.inverse_inertia * arm_a * arm_a +
                                b.inverse_inertia * arm_b * arm_b;
    square = std::max(square, length(joint.force) * inverse_mass / lever);
    const double speed = joint.length > 0 ? length(b.velocity - a.velocity) / joint.length : 0;
    square = std::max({square, speed * speed, a.spin * a.spin, b.spin * b.spin});
  }
  return std::sqrt(square);
}

// Corrects the velocity of a free linkage as a whole, after a step with limited masses.
void RigidLinkage::restoreMomentum(std::span<const RigidBody> bodies) {
  if (!m_is_free) return;
  Vec2 missing;
  double mass = 0;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    const RigidBody& body = bodies[at(m_nodes[i].body)];
    if (!(body.inverse_mass > 0)) continue;
    missing += (body.velocity + body.acceleration - m_nodes[i].velocity) / body.inverse_mass;
    mass += 1 / body.inverse_mass;
  }
  for (Node& node : m_nodes) node.velocity += missing / mass;
}

int RigidLinkage::step(std::span<const RigidBody> bodies, std::span<RigidState> states, RigidJoints& joints,
                       LinkageCounters& counters) {
  const double rate = rateOf(bodies, joints);
  bool is_done = false, is_again = false;
  int substeps = kLeastSubsteps;
  if (rate <= kCalm) {
    load(bodies, joints, substeps);
    is_again = true;
    is_done = m_is_conservative && run(kComposed, counters);
  }
  for (; !is_done && substeps <= kMostSubsteps; substeps *= 2) {
    if (rate > kLargestTurn * substeps) continue;
    if (is_again) ++counters.refined;
    is_again = true;
    load(bodies, joints, substeps);
    const std::array<double, kMostSubsteps> lengths = equalLengths(substeps);
    is_done = run(std::span(lengths).first(at(substeps)), counters);
    if (is_done) break;
  }
  double weight = 1;  // ratio of the true forces to those found
  if (!is_done) {
    ++counters.approximate;
    load(bodies, joints, kLeastSubsteps);
    const double kinetic = motion().kinetic;
    for (substeps = kMostSubsteps / 2; !is_done && substeps <= kMostSubsteps; substeps *= 2) {
      load(bodies, joints, substeps);
      weight = limitMasses();
      const std::array<double, kMostSubsteps> lengths = equalLengths(substeps);
      is_done = run(std::span(lengths).first(at(substeps)), counters);
    }
    if (!is_done) {
      load(bodies, joints, kLeastSubsteps);
      weight = limitMasses();
      evaluate<true>(*m_p_joints);
      for (int i = 0; i < kLeastSubsteps; ++i) approximate(1.0 / kLeastSubsteps);
    }
    restoreMomentum(bodies);
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      const RigidBody& body = bodies[at(m_nodes[i].body)];
      m_mass[i] = {body.inverse_mass, body.inverse_inertia};
    }
    if (m_is_conservative) setKinetic(std::max(0.0, kinetic + work(true)), 0, 1);
  }
  giveVelocities(states);
  givePlaces(states);
  int broken = 0;
  for (const Link& link : m_links) {
    JointStore::Memory& memory = joints.memoryOf(link.id);
    for (int k = 0; k < link.count; ++k)
      memory[at(k)] = (m_first[at(link.row[k])] + m_second[at(link.row[k])]) / m_last_h;
    joints.skip(link.id);
    broken += joints.finish(link.id, weight * link.force, weight * link.torque) ? 1 : 0;
  }
  return broken;
}

}  // namespace naiad::physics
