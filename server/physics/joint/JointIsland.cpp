#include "physics/joint/JointIsland.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/joint/JointRod.h"

namespace naiad::physics {

namespace {

constexpr double kLargest = 1e15;  // of a way or speed within an island: beyond it places have no digits left

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

bool isMovable(const JointBody& body) {
  return body.inverse_mass > 0 || body.inverse_inertia > 0;
}

bool isBelow(Vec2 a, double limit) {
  return std::abs(a.x) <= limit && std::abs(a.y) <= limit;
}

constexpr int kFiner = 2, kFinest = 16;
constexpr int kPatience = 3;  // steps that went well, until longer stages are tried again

Vec2 accelerationOf(const JointBody& body, Vec2 gravity) {
  return body.inverse_mass > 0 ? gravity + body.inverse_mass * body.force : Vec2{};
}

}  // namespace

bool JointIsland::load(std::span<const JointBody> bodies, std::span<const Joint> joints, Vec2 gravity) {
  const Place& first = bodies[at(m_body[0])].place;
  m_origin = {first.cell_x, first.cell_y, 0, 0};
  m_joints = joints.data();
  m_is_turning = false;
  double extent = 1;
  bool is_good = isBelow(gravity, kLargest);
  for (std::size_t i = 0; i < m_body.size(); ++i) {
    const JointBody& body = bodies[at(m_body[i])];
    m_place[i] = body.place - m_origin;
    m_velocity[i] = body.velocity;
    m_rotation[i] = body.rotation;
    m_spin[i] = body.spin;
    m_acceleration[i] = accelerationOf(body, gravity);
    m_turn_acceleration[i] = body.inverse_inertia * body.torque;
    m_is_turning |= body.inverse_inertia > 0 || body.spin != 0;
    extent = std::max({extent, std::abs(m_place[i].x), std::abs(m_place[i].y)});
    is_good = is_good && isBelow(m_place[i], kLargest) && isBelow(m_velocity[i], kLargest) &&
              isBelow(m_acceleration[i], kLargest) &&
              isBelow({body.spin, m_turn_acceleration[i]}, kLargest) &&
              isBelow({body.rotation.c, body.rotation.s}, 2);
  }
  if (!is_good) return false;
  m_tolerance = std::max(2e-13, 0x1p-50 * extent);
  for (Link& link : m_links) {
    const Joint& joint = joints[at(link.index)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (link.row[k] >= 0) m_multiplier[at(link.row[k])] = joint.memory[k];
    }
    if (joint.kind == JointKind::kMouse) link.target = joint.target - m_origin;
  }
  m_last_h = 1;
  m_is_beyond = false;
  std::fill(m_force.begin(), m_force.end(), Vec2{});
  std::fill(m_torque.begin(), m_torque.end(), 0.0);
  setArms();
  evaluate<true>();
  return true;
}

bool JointIsland::store(std::span<JointBody> bodies, std::span<Joint> joints, double h) const {
  for (std::size_t i = 0; i < m_body.size(); ++i) {
    const bool is_good = isBelow(m_place[i], kLargest) && isBelow(m_velocity[i], kLargest) &&
                         std::abs(m_spin[i]) <= kLargest && isBelow({m_rotation[i].c, m_rotation[i].s}, 2);
    if (!is_good) return false;
  }
  for (std::size_t i = 0; i < m_body.size(); ++i) {
    JointBody& body = bodies[at(m_body[i])];
    if (!isMovable(body)) continue;
    body.place = m_origin + m_place[i];
    body.velocity = m_velocity[i];
    body.spin = m_spin[i];
    if (m_is_turning) body.rotation = renormalised(m_rotation[i]);
  }
  for (std::size_t i = 0; i < m_links.size(); ++i) {
    Joint& joint = joints[at(m_links[i].index)];
    joint.force = m_force[i] / h;
    joint.torque = m_torque[i] / h;
    for (std::size_t k = 0; k < 3; ++k) {
      if (m_links[i].row[k] >= 0) joint.memory[k] = m_multiplier[at(m_links[i].row[k])] / m_last_h;
    }
  }
  return true;
}

void JointIsland::freeze(std::span<JointBody> bodies, JointCounters& counters) {
  for (const int index : m_body) {
    JointBody& body = bodies[at(index)];
    if (!isMovable(body)) continue;
    body.velocity = {};
    body.spin = 0;
  }
  m_is_frozen = true;
  ++counters.quarantined;
}

bool JointIsland::mayCompose(std::span<const Joint> joints, double h) const {
  if (!m_one_sided.empty()) return false;
  for (const int row : m_soft) {
    const Joint& joint = joints[at(m_links[at(m_link_of[at(row)])].index)];
    const double answer = m_mass[at(m_rows[at(row)].b)].inverse_mass +
                          (m_rows[at(row)].a < 0 ? 0 : m_mass[at(m_rows[at(row)].a)].inverse_mass);
    if (joint.damping > 0 || h * h * joint.stiffness * answer > 1) return false;
  }
  return true;
}

// Does h resolve how fast the joints' forces turn them? Composed steps are longer than h / substeps, and gain
// nothing where they resolve nothing (a whip, a heavy weight on a light chain).
bool JointIsland::isCalm(std::span<const Joint> joints, double h) const {
  const double square = h * h;
  return std::none_of(m_links.begin(), m_links.end(), [&](const Link& link) {
    return square * square * lengthSquared(joints[at(link.index)].force) > link.most_force * link.most_force;
  });
}

bool JointIsland::stepRod(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
                          JointOptions options, JointCounters& counters) const {
  Joint& joint = joints[at(m_links[0].index)];
  JointBody& a = bodies[at(joint.a)];
  JointBody& b = bodies[at(joint.b)];
  const double sum = a.inverse_mass + b.inverse_mass;
  const double per_length = 1 / joint.length;
  const Vec2 push_a = accelerationOf(a, gravity), push_b = accelerationOf(b, gravity);
  const Vec2 start = b.place - a.place, direction = start / joint.length;
  const double square = lengthSquared(direction);
  const bool is_good = sum > 0 && a.spin == 0 && b.spin == 0 && std::abs(square - 1) <= 1e-6 &&
                       isBelow(a.velocity, kLargest) && isBelow(b.velocity, kLargest) &&
                       isBelow(push_a, kLargest) && isBelow(push_b, kLargest);
  if (!is_good) return false;
  const double share_a = a.inverse_mass / sum, share_b = b.inverse_mass / sum;
  // Close to one, the root of the square needs no root.
  const double to_unit = std::abs(square - 1) <= 1e-10 ? 1.5 - 0.5 * square : 1 / std::sqrt(square);
  JointRod rod(to_unit * direction, per_length * (b.velocity - a.velocity), per_length * (push_b - push_a));
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = std::max(1, options.substeps / static_cast<int>(stages.size()));
  const double whole = h / repeats;
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      if (!rod.advance(share * whole, 1 / (share * whole))) return false;
    }
  }
  counters.stages += stages.size() * static_cast<std::size_t>(repeats);
  const Vec2 velocity = share_b * a.velocity + share_a * b.velocity;
  const Vec2 push = share_b * push_a + share_a * push_b;
  const Vec2 flown = h * (velocity + (0.5 * h) * push), after = velocity + h * push;
  const Vec2 turned = joint.length * rod.direction - start, velocity_after = joint.length * rod.velocity();
  if (a.inverse_mass > 0) {
    a.place = a.place + (flown - share_a * turned);
    a.velocity = after - share_a * velocity_after;
  }
  if (b.inverse_mass > 0) {
    b.place = b.place + (flown + share_b * turned);
    b.velocity = after + share_b * velocity_after;
  }
  joint.force = (joint.length / (h * sum)) * rod.pull;
  return true;
}

void JointIsland::hold(std::span<JointBody> bodies, std::span<const Joint> joints, JointCounters& counters) {
  if (m_is_frozen || !load(bodies, joints, {})) return;
  prepareHold();
  projectVelocities(counters);
  for (std::size_t i = 0; i < m_body.size(); ++i) {
    JointBody& body = bodies[at(m_body[i])];
    if (!isMovable(body)) continue;
    body.velocity = m_velocity[i];
    body.spin = m_spin[i];
  }
}

void JointIsland::prepareHold() {
  if (m_is_smooth) return;
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    m_is_out_second[i] = m_kind[i] == Kind::kSoft || m_kind[i] == Kind::kMotor || m_side[i] != 0 ? 1 : 0;
  }
}

JointChain::Status JointIsland::stepChain(JointOptions options, double h, JointCounters& counters) {
  m_chain.load(m_place, m_velocity, m_acceleration, m_multiplier, m_tolerance);
  JointChain::Status status = m_chain.project();
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = std::max(1, options.substeps / static_cast<int>(stages.size()));
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      if (status != JointChain::Status::kDone) return status;
      ++counters.stages;
      status = m_chain.stage(share * (h / repeats), counters.iterations);
    }
  }
  if (status != JointChain::Status::kDone) return status;
  m_chain.store(m_place, m_velocity, m_multiplier, m_force, m_link_of);
  m_is_factored = false;
  return status;
}

bool JointIsland::stepBy(JointOptions options, bool is_last, std::span<const JointBody> bodies,
                         std::span<const Joint> joints, double h, Vec2 gravity, JointCounters& counters) {
  if (!load(bodies, joints, gravity)) return false;
  if (!is_last && !m_chain.isEmpty() && !m_is_turning) {
    const JointChain::Status status = stepChain(options, h, counters);
    if (status != JointChain::Status::kBad) return status == JointChain::Status::kDone;
  }
  prepareHold();
  projectVelocities(counters);
  record(m_second);
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = std::max(1, options.substeps / static_cast<int>(stages.size()));
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      const double length = share * (h / repeats);
      if (!(is_last ? advance(length, 0, counters) : stage(length, counters))) return false;
    }
  }
  return true;
}

void JointIsland::step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
                       JointOptions options, JointCounters& counters) {
  if (m_is_frozen) return;
  if (options.method == JointMethod::kAutomatic) {
    options.method = isCalm(joints, h) ? JointMethod::kSuzuki4 : JointMethod::kRattle;
  }
  if (m_is_rod && stepRod(bodies, joints, h, gravity, options, counters)) return;
  if (!mayCompose(joints, h)) options.method = JointMethod::kRattle;
  // A step whose stages do not converge is done again with shorter ones, all of it: lengths that change
  // within a step cost more energy than long ones do. What is left to the last try may halve and fall back.
  // What the last step needed, the next one is likely to need, too.
  const int first = m_finer;
  bool is_done = false;
  for (int finer = first; !is_done && finer <= kFinest; finer *= kFiner) {
    if (finer > first) ++counters.refined;
    if (finer > 1) options.method = JointMethod::kRattle;
    const JointOptions refined = {options.method, options.substeps * finer};
    is_done = stepBy(refined, false, bodies, joints, h, gravity, counters);
    m_finer = finer;
  }
  if (m_finer > first || !is_done) m_calm_steps = 0;
  if (++m_calm_steps > kPatience && m_finer > 1) {
    m_finer /= kFiner;
    m_calm_steps = 0;
  }
  options.method = JointMethod::kRattle;
  if (!is_done) is_done = stepBy(options, true, bodies, joints, h, gravity, counters);
  if (!is_done || !store(bodies, joints, h)) freeze(bodies, counters);
}

}  // namespace naiad::physics
