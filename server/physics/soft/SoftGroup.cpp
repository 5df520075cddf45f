// A sub-step of a SoftWorld: finds groups of bodies that touch, and solves each.
#include <algorithm>
#include <cmath>

#include "physics/soft/SoftWorld.h"

namespace naiad::physics {

namespace {

constexpr int kMaxIterations = 12;  // for Newton's method; stiffness 1e10 needs three (docs/physics/soft.md)
/// Limit of iterations with contacts, which cost more; the next sub-step corrects the remaining error.
constexpr int kMaxContactIterations = 4;
/// Required accuracy of offsets, as a part of the radius: without contacts and attachments, and with them.
constexpr double kTolerance = 1e-9;
constexpr double kContactTolerance = 1e-6;

bool isMovable(const SoftObstacleMotion& push) {
  return push.inverse_mass > 0 || push.inverse_inertia > 0;
}

}  // namespace

void SoftWorld::substep(double h, std::span<SoftObstacle> obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    m_obstacle_motions[i].velocity += h * obstacles[i].acceleration;
  updateViews(h, obstacles);
  findRows(h, obstacles);
  for (const SoftView& view : m_views) {
    State& state = m_states[at(view.id)];
    state.is_worked_on = false;
    // A contact interrupts the smooth history of the motion; an attachment does not.
    const bool is_touched = std::any_of(m_rows.begin(), m_rows.end(), [&](const SoftRow& row) {
      return !row.is_attachment && (row.a.body == view.id || row.b.body == view.id);
    });
    if (is_touched) m_elastics[at(view.id)].forgetHistory();
  }
  separateWide();
  for (const SoftView& view : m_views) {
    if (isWide(view.id)) solveWide(view, h, obstacles);
  }
  for (const SoftView& view : m_views) {
    if (!isWide(view.id)) m_elastics[at(view.id)].begin(m_bodies[at(view.id)], h, m_gravity, true);
  }
  findGroups();
  solveGroups(h);
  for (const SoftRow& row : m_rows) recordRow(row, h, obstacles);
  for (const SoftView& view : m_views) {
    if (!isLive(view.id) || isWide(view.id)) continue;
    stopNodes(view.id, h, obstacles);
    m_elastics[at(view.id)].finish(m_bodies[at(view.id)]);
    if (limitEnergy(view.id)) stopNodes(view.id, h, obstacles);
  }
  moveObstacles(h, obstacles);
  m_earlier.swap(m_rows);
  m_earlier.insert(m_earlier.end(), m_wide_rows.begin(), m_wide_rows.end());
  std::sort(m_earlier.begin(), m_earlier.end(),
            [](const SoftRow& a, const SoftRow& b) { return a.key < b.key; });
}

// Finds the groups of bodies that are connected by rows, directly or through movable obstacles.
void SoftWorld::findGroups() {
  const int bodies = idLimit();
  m_links.reset(at(bodies) + m_obstacle_motions.size());
  for (const SoftRow& row : m_rows) {
    const bool joins = row.b.body >= 0 || isMovable(m_obstacle_motions[at(row.obstacle)]);
    if (!joins) continue;
    m_links.unite(row.a.body, row.b.body >= 0 ? row.b.body : bodies + row.obstacle);
  }
  for (const SoftView& view : m_views) m_states[at(view.id)].group = m_links.rootOf(view.id);
}

void SoftWorld::solveGroups(double h) {
  for (const SoftView& lead : m_views) {
    if (m_states[at(lead.id)].group != lead.id || isWide(lead.id)) continue;
    for (bool is_done = false; !is_done;) {
      m_group.clear();
      m_group_rows.clear();
      for (const SoftView& view : m_views) {
        if (isLive(view.id) && m_states[at(view.id)].group == lead.id) m_group.push_back(view.id);
      }
      for (SoftRow& row : m_rows) {
        const bool is_live = isLive(row.a.body) && (row.b.body < 0 || isLive(row.b.body));
        if (!is_live) row.forces[0] = row.forces[1] = 0;
        if (is_live && m_states[at(row.a.body)].group == lead.id) m_group_rows.push_back(&row);
      }
      is_done = solveGroup(h);
      if (is_done) continue;
      for (const int id : m_group) {  // a body was frozen: solve the group again without it
        m_elastics[at(id)].revert(m_bodies[at(id)]);
        if (!isLive(id)) continue;
        m_elastics[at(id)].forgetHistory();
        m_elastics[at(id)].begin(m_bodies[at(id)], h, m_gravity, false);
      }
    }
  }
}

// Solves the current group. Returns false if a body had to be frozen.
bool SoftWorld::solveGroup(double h) {
  const bool is_touched = std::any_of(m_group_rows.begin(), m_group_rows.end(),
                                      [](const SoftRow* row) { return !row->is_attachment; });
  const int most = is_touched ? kMaxContactIterations : kMaxIterations;
  bool is_settled = false;
  for (int i = 0; i < most && !is_settled; ++i) {
    if (!iterate(h, is_settled)) return false;
  }
  if (!is_settled) ++m_counters.unconverged;
  return true;
}

bool SoftWorld::iterate(double h, bool& is_settled) {
  const bool has_rows = !m_group_rows.empty();
  for (const int id : m_group) {
    ++m_counters.iterations;
    const bool is_done = m_elastics[at(id)].assemble(m_bodies[at(id)], !has_rows);
    if (!m_elastics[at(id)].isKept()) ++m_counters.decompositions;
    if (is_done) continue;
    freeze(id);
    return false;
  }
  is_settled =
      !has_rows || m_solver.solve({m_bodies, m_elastics, m_obstacle_motions, h}, m_group, m_group_rows);
  for (const int id : m_group) {
    const std::span<const double> change = has_rows ? m_solver.changeOf(id) : m_elastics[at(id)].change();
    for (const double c : change) {
      if (std::fabs(c) <= kFarthest) continue;
      freeze(id);
      return false;
    }
    const double most = m_elastics[at(id)].apply(m_bodies[at(id)], change);
    is_settled = is_settled && most <= (has_rows ? kContactTolerance : kTolerance) * m_bodies[at(id)].radius;
  }
  return true;
}

// Records the effects of a row on obstacles, on the limit of energy, and on events.
void SoftWorld::recordRow(const SoftRow& row, double h, std::span<SoftObstacle> obstacles) {
  if (row.forces[0] == 0 && row.forces[1] == 0) return;
  const Vec2 impulse = h * (row.forces[0] * row.axes[0] + row.forces[1] * row.axes[1]);
  if (row.obstacle >= 0) {
    SoftObstacle& obstacle = obstacles[at(row.obstacle)];
    SoftObstacleMotion& push = m_obstacle_motions[at(row.obstacle)];
    const double twist = cross(row.lever, impulse);
    obstacle.impulse -= impulse;
    obstacle.angular_impulse -= twist;
    push.velocity -= push.inverse_mass * impulse;
    push.spin -= push.inverse_inertia * twist;
    const bool is_still = !isMovable(push) && push.velocity == Vec2{} && push.spin == 0;
    if (!is_still) m_states[at(row.a.body)].is_worked_on = true;
  } else {
    m_states[at(row.a.body)].is_worked_on = m_states[at(row.b.body)].is_worked_on = true;
  }
  if (row.is_attachment || row.forces[0] <= 0) return;
  const bool is_soft = row.obstacle < 0;
  const int other = is_soft ? std::max(row.a.body, row.b.body) : obstacles[at(row.obstacle)].id;
  const int body = is_soft ? std::min(row.a.body, row.b.body) : row.a.body;
  const std::uint64_t key = static_cast<std::uint64_t>(body) << 33 |
                            static_cast<std::uint64_t>(is_soft) << 32 | static_cast<std::uint32_t>(other);
  const auto place = std::lower_bound(m_touching.begin(), m_touching.end(), key,
                                      [](const Touch& t, std::uint64_t k) { return t.key < k; });
  if (place != m_touching.end() && place->key == key) {
    place->impulse += h * row.forces[0];
  } else {
    m_touching.insert(place, {key, h * row.forces[0]});
  }
}

void SoftWorld::moveObstacles(double h, std::span<SoftObstacle> obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    obstacles[i].displacement += h * m_obstacle_motions[i].velocity;
    obstacles[i].turn += h * m_obstacle_motions[i].spin;
  }
}

// Stops the nodes whose path still crosses an obstacle.
void SoftWorld::stopNodes(int id, double h, std::span<SoftObstacle> obstacles) {
  SoftBody& body = m_bodies[at(id)];
  for (const int node : body.boundary) {
    if (body.nodes[at(node)].is_pinned) continue;
    for (SoftPose& pose : m_poses) {
      pose.velocity = m_obstacle_motions[at(pose.index)].velocity,
      pose.spin = m_obstacle_motions[at(pose.index)].spin;
      stopNode(id, node, pose, h, obstacles[at(pose.index)]);
    }
  }
}

void SoftWorld::stopNode(int id, int node, const SoftPose& pose, double h, SoftObstacle& obstacle) {
  SoftBody& body = m_bodies[at(id)];
  Vec2& offset = body.nodes[at(node)].offset;
  const Vec2 from = m_elastics[at(id)].startOf(node), displacement = offset - from;
  const Vec2 apart = from - (pose.place - body.place);
  const double reach = pose.reach + length(displacement) + h * length(pose.velocity);
  if (lengthSquared(apart) > reach * reach) return;
  for (const SoftRow& row : m_rows) {
    const bool is_held = row.is_attachment && row.a.body == id;
    if (is_held && row.obstacle == pose.index) return;
  }
  const double free = freeFraction(body, from, offset, pose, h);
  if (free == 1) return;
  const Vec2 carried = h * (pose.velocity + cross(pose.spin, apart));  // the surface carries the node along
  const Vec2 stopped = from + carried + free * (displacement - carried);
  const Vec2 impulse = body.nodes[at(node)].mass / m_elastics[at(id)].beta() * (stopped - offset);
  const double twist = cross(apart, impulse);
  SoftObstacleMotion& push = m_obstacle_motions[at(pose.index)];
  obstacle.impulse -= impulse;
  obstacle.angular_impulse -= twist;
  push.velocity -= push.inverse_mass * impulse;
  push.spin -= push.inverse_inertia * twist;
  offset = stopped;
  if (pose.velocity != Vec2{} || pose.spin != 0) m_states[at(id)].is_worked_on = true;
  ++m_counters.stopped;
}

// Prevents a body from gaining energy in a sub-step without work on it. Removes the excess from the motion
// relative to its mean velocity. If that is not enough, moves the body back to its start, and returns true.
bool SoftWorld::limitEnergy(int id) {
  SoftBody& body = m_bodies[at(id)];
  State& state = m_states[at(id)];
  double energy = energyOf(body, m_gravity);
  bool is_held = false;
  bool is_driven = state.is_worked_on;
  double mass = 0, moving = 0;
  Vec2 momentum;
  for (const SoftNode& node : body.nodes) {
    is_held = is_held || node.is_pinned;
    is_driven = is_driven || (node.is_pinned && node.velocity != Vec2{});
    if (node.is_pinned) continue;
    mass += node.mass;
    momentum += node.mass * node.velocity;
    moving += 0.5 * node.mass * lengthSquared(node.velocity);
  }
  if (is_driven) state.budget = energy;
  const double excess = energy - state.budget;
  if (excess <= 1e-9 * moving + 1e-12 * std::fabs(energy)) return false;
  ++m_counters.limited;
  const Vec2 common = is_held || mass == 0 ? Vec2{} : momentum / mass;
  const double within = moving - 0.5 * mass * lengthSquared(common);
  double factor = 0;
  if (within > excess) {
    factor = std::sqrt(1 - excess / within);
  } else {
    m_elastics[at(id)].revert(body);
  }
  for (SoftNode& node : body.nodes) {
    if (!node.is_pinned) node.velocity = common + factor * (node.velocity - common);
  }
  if (factor < 0.999) m_elastics[at(id)].forgetHistory();
  return factor == 0;
}

}  // namespace naiad::physics
