#include "physics/soft/SoftRows.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr int kMaxSweeps = 60;  // Gauss–Seidel sweeps per iteration; the next iteration continues from there
/// Limit of sweeps times rows, so that large groups have fewer sweeps, but at least kMinSweeps.
constexpr int kMaxSettlings = 40'000;
constexpr int kMinSweeps = 8;
/// Sweeps end when no force moves its row by more than this part of a radius.
constexpr double kSettled = 1e-7;
/// The solution counts as failed if the last sweep moved a row by more than this part of a radius.
constexpr double kNearlySettled = 1e-4;

double along(const SoftElastic& elastic, const SoftPoint& point, Vec2 axis, const double* rows) {
  double sum = 0;
  for (int k = 0; k < 2 && point.nodes[k] >= 0; ++k) {
    const int row = elastic.rowOf(point.nodes[k]);
    sum += point.weights[k] * dot(axis, {rows[row], rows[row + 1]});
  }
  return sum;
}

const SoftPoint& sideOf(const SoftRow& row, int side) {
  return side == 0 ? row.a : row.b;
}

}  // namespace

void SoftRowSolver::gather(const Scene& scene, const std::vector<int>& group) {
  m_begins.resize(scene.bodies.size());
  m_sizes.resize(scene.bodies.size());
  m_changes.clear();
  for (const int id : group) {
    const std::vector<double>& change = scene.elastics[at(id)].change();
    m_begins[at(id)] = m_changes.size();
    m_sizes[at(id)] = change.size();
    m_changes.insert(m_changes.end(), change.begin(), change.end());
  }
  m_motions = scene.obstacle_motions;
  m_responses.clear();
}

void SoftRowSolver::respond(const Scene& scene, SoftRow& row) {
  for (int axis = 0; axis < 2; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const SoftPoint& point = sideOf(row, side);
      if (point.body < 0) continue;
      const SoftElastic& elastic = scene.elastics[at(point.body)];
      const std::size_t begin = m_responses.size();
      row.responses[axis][side] = static_cast<int>(begin);
      m_responses.resize(begin + at(elastic.rows()), 0);
      const Vec2 force = (side == 0 ? 1 : -1) * row.axes[axis];
      for (int k = 0; k < 2 && point.nodes[k] >= 0; ++k) {
        if (scene.bodies[at(point.body)].nodes[at(point.nodes[k])].is_pinned) continue;
        const std::size_t r = begin + at(elastic.rowOf(point.nodes[k]));
        m_responses[r] += point.weights[k] * force.x, m_responses[r + 1] += point.weights[k] * force.y;
      }
      elastic.respond(&m_responses[begin]);
    }
  }
}

// Adds a force along a row's axis to the motion of both sides.
void SoftRowSolver::push(const Scene& scene, const SoftRow& row, int axis, double force) {
  if (force == 0) return;
  for (int side = 0; side < 2; ++side) {
    const SoftPoint& point = sideOf(row, side);
    if (point.body < 0) continue;
    const double* response = &m_responses[at(row.responses[axis][side])];
    double* change = &m_changes[m_begins[at(point.body)]];
    for (std::size_t i = 0; i < m_sizes[at(point.body)]; ++i) change[i] += force * response[i];
  }
  if (row.obstacle < 0) return;
  SoftObstacleMotion& rigid = m_motions[at(row.obstacle)];
  const Vec2 impulse = scene.h * force * row.axes[axis];
  rigid.velocity -= rigid.inverse_mass * impulse;
  rigid.spin -= rigid.inverse_inertia * cross(row.lever, impulse);
}

// Returns how far the two sides of a row separate, by this iteration's changes and the obstacle's motion.
double SoftRowSolver::moved(const Scene& scene, const SoftRow& row, int axis) const {
  double sum = 0;
  for (int side = 0; side < 2; ++side) {
    const SoftPoint& point = sideOf(row, side);
    if (point.body < 0) continue;
    const double* change = &m_changes[m_begins[at(point.body)]];
    sum += (side == 0 ? 1 : -1) * along(scene.elastics[at(point.body)], point, row.axes[axis], change);
  }
  if (row.obstacle < 0) return sum;
  const SoftObstacleMotion& rigid = m_motions[at(row.obstacle)];
  return sum - scene.h * dot(row.axes[axis], rigid.velocity + cross(rigid.spin, row.lever));
}

double SoftRowSolver::fixedGap(const Scene& scene, const SoftRow& row, int axis) const {
  double gap = row.gaps[axis];
  for (int side = 0; side < 2; ++side) {
    const SoftPoint& point = sideOf(row, side);
    for (int k = 0; k < 2 && point.body >= 0 && point.nodes[k] >= 0; ++k) {
      const Vec2 now = scene.bodies[at(point.body)].nodes[at(point.nodes[k])].offset;
      const Vec2 went = now - scene.elastics[at(point.body)].startOf(point.nodes[k]);
      gap += (side == 0 ? 1 : -1) * point.weights[k] * dot(row.axes[axis], went);
    }
  }
  if (row.is_attachment || axis == 1) return gap;
  return gap + lastingDepth(row, scene.bodies[at(row.a.body)].radius);
}

double SoftRowSolver::compliance(const Scene& scene, const SoftRow& row, int axis) const {
  double sum = 0;
  for (int side = 0; side < 2; ++side) {
    const SoftPoint& point = sideOf(row, side);
    if (point.body < 0) continue;
    const double* response = &m_responses[at(row.responses[axis][side])];
    sum += (side == 0 ? 1 : -1) * along(scene.elastics[at(point.body)], point, row.axes[axis], response);
  }
  if (row.obstacle < 0) return sum;
  const SoftObstacleMotion& rigid = scene.obstacle_motions[at(row.obstacle)];
  const double twist = cross(row.lever, row.axes[axis]);
  return sum + scene.h * scene.h * (rigid.inverse_mass + rigid.inverse_inertia * twist * twist);
}

// Solves one row while all others are fixed. Returns how far the row has moved.
double SoftRowSolver::settle(const Scene& scene, std::size_t index, SoftRow& row) {
  double most = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const double compliance = m_compliances[2 * index + at(axis)];
    const bool is_free = axis == 1 && !row.is_attachment && row.friction == 0;
    if (is_free || !(compliance > 1e-300)) continue;
    double force = row.forces[axis] - (m_gaps[2 * index + at(axis)] + moved(scene, row, axis)) / compliance;
    if (!row.is_attachment) {
      const double limit = row.friction * row.forces[0];
      force = axis == 0 ? std::max(0.0, force) : std::clamp(force, -limit, limit);
    }
    const double more = force - row.forces[axis];
    most = std::max(most, compliance * std::fabs(more));
    push(scene, row, axis, more);
    row.forces[axis] = force;
  }
  return most;
}

bool SoftRowSolver::solve(const Scene& scene, const std::vector<int>& group, std::vector<SoftRow*>& rows) {
  gather(scene, group);
  m_gaps.clear();
  m_compliances.clear();
  double scale = 1e300;
  for (SoftRow* row : rows) {
    respond(scene, *row);
    scale = std::min(scale, scene.bodies[at(row->a.body)].radius);
    for (int axis = 0; axis < 2; ++axis) {
      m_gaps.push_back(fixedGap(scene, *row, axis));
      m_compliances.push_back(compliance(scene, *row, axis));
      push(scene, *row, axis, row->forces[axis]);
    }
  }
  const int affordable = kMaxSettlings / std::max(1, static_cast<int>(rows.size()));
  const int sweeps = std::clamp(affordable, kMinSweeps, kMaxSweeps);
  double most = 1e300;
  for (int i = 0; i < sweeps && most > kSettled * scale; ++i) {
    most = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::size_t index = i % 2 == 0 ? k : rows.size() - 1 - k;
      most = std::max(most, settle(scene, index, *rows[index]));
    }
  }
  return most <= kNearlySettled * scale;
}

}  // namespace naiad::physics
