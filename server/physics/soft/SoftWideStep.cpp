// A sub-step of a wide body (SoftElastic.h), which is done before the sub-steps of other bodies.
//
// A contact is a stiff implicit spring within the body's own system, so it costs as much as one more spring.
// The other side yields according to its mass. If a mass has several contacts, it is divided between them
// (mass splitting), so that together they do not push too much. At last the other sides get the impulses.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "physics/soft/SoftWorld.h"

namespace naiad::physics {

namespace {

/// Iterations in a sub-step. The second one finds threads that have become taut, and contacts that open or
/// close. The next sub-step corrects the error of the linear solution.
constexpr int kWideIterations = 2;
/// Stiffness of a contact and of an attachment, relative to the stiffness of the node with its springs.
constexpr double kContactStiffness = 20, kAttachmentStiffness = 100;

// Returns the movement of a point of a body in this sub-step so far.
Vec2 movementOf(const SoftBody& body, const SoftElastic& elastic, const SoftPoint& point) {
  Vec2 sum;
  for (int k = 0; k < 2 && point.nodes[k] >= 0; ++k) {
    sum += point.weights[k] * (body.nodes[at(point.nodes[k])].offset - elastic.startOf(point.nodes[k]));
  }
  return sum;
}

// Returns how far A has moved away from B in this sub-step.
Vec2 apartOf(const SoftPush& push, const SoftBody& body, const SoftElastic& elastic) {
  return push.sign * (movementOf(body, elastic, *push.p_own) - push.gone);
}

Vec2 changeOf(const SoftElastic& elastic, const SoftPoint& point) {
  Vec2 sum;
  for (int k = 0; k < 2 && point.nodes[k] >= 0; ++k) {
    const std::size_t row = at(elastic.rowOf(point.nodes[k]));
    sum += point.weights[k] * Vec2{elastic.change()[row], elastic.change()[row + 1]};
  }
  return sum;
}

// Chooses the push's forces for the next solution. Those of an open or sliding axis ignore the gap.
void choose(SoftPush& push, Vec2 apart) {
  SoftRow& row = *push.p_row;
  for (int axis = 0; axis < 2; ++axis) {
    const double gap = (axis == 0 ? push.gap : row.gaps[1]) + dot(row.axes[axis], apart);
    push.force[axis] = -push.stiffness * gap;
    push.yield[axis] = push.stiffness;
    if (row.is_attachment) continue;
    const bool is_open = axis == 0 ? row.forces[0] <= 0 && gap >= 0 : push.yield[0] == 0 || row.friction == 0;
    const bool is_sliding =
        axis == 1 && row.forces[1] != 0 && std::fabs(row.forces[1]) >= 0.999 * row.friction * row.forces[0];
    if (is_open) push.force[axis] = push.yield[axis] = 0;
    if (is_sliding && !is_open) push.force[1] = row.forces[1], push.yield[1] = 0;
  }
}

void addTo(SoftElastic& elastic, const SoftPush& push) {
  for (int k = 0; k < 2 && push.p_own->nodes[k] >= 0; ++k) {
    const double weight = push.p_own->weights[k];
    for (int axis = 0; axis < 2; ++axis) {
      elastic.addPush(push.p_own->nodes[k], push.sign * push.p_row->axes[axis], weight * push.force[axis],
                      weight * push.yield[axis]);
    }
  }
}

// Limits the resulting forces, which are the first guess of the next iteration or sub-step.
void limit(SoftPush& push, Vec2 apart) {
  SoftRow& row = *push.p_row;
  if (row.is_attachment) return;
  row.forces[0] = std::max(0.0, row.forces[0]);
  const double most = row.friction * row.forces[0], slid = dot(row.axes[1], apart);
  const bool is_sliding = push.yield[1] == 0 && push.force[1] != 0;
  if (is_sliding) {  // friction in the direction of the motion is set to zero
    row.forces[1] = push.force[1] * slid < 0 ? std::copysign(most, push.force[1]) : 0;
  } else {
    row.forces[1] = std::clamp(row.forces[1], -most, most);
  }
}

}  // namespace

// Moves the rows of wide bodies to m_wide_rows, because these are solved for one body at a time.
void SoftWorld::separateWide() {
  m_wide_rows.clear();
  if (m_patches.empty()) return;
  const auto isWideRow = [this](const SoftRow& row) {
    return isWide(row.a.body) || (row.b.body >= 0 && isWide(row.b.body));
  };
  std::copy_if(m_rows.begin(), m_rows.end(), std::back_inserter(m_wide_rows), isWideRow);
  std::erase_if(m_rows, isWideRow);
}

SoftPush SoftWorld::pushOf(SoftRow& row, int id, double h) const {
  SoftPush push;
  push.p_row = &row;
  const bool is_first = row.a.body == id;
  push.sign = is_first ? 1 : -1;
  push.p_own = is_first ? &row.a : &row.b;
  push.p_other = is_first ? &row.b : &row.a;
  if (row.obstacle >= 0) {
    const SoftObstacleMotion& motion = m_obstacle_motions[at(row.obstacle)];
    push.gone = h * (motion.velocity + cross(motion.spin, row.lever));
  } else {
    const SoftBody& other = m_bodies[at(push.p_other->body)];
    for (int k = 0; k < 2 && push.p_other->nodes[k] >= 0; ++k) {
      const SoftNode& node = other.nodes[at(push.p_other->nodes[k])];
      const Vec2 pull = node.is_pinned ? Vec2{} : m_gravity + node.force / node.mass;
      push.gone += push.p_other->weights[k] * h * (node.velocity + h * pull);
    }
  }
  push.gap = row.gaps[0] + (row.is_attachment ? 0 : lastingDepth(row, m_bodies[at(id)].radius));
  return push;
}

// Collects the pushes of a body, and counts how many act on each obstacle or node of another body.
void SoftWorld::gatherPushes(const SoftView& view, double h) {
  m_pushes.clear();
  m_sharing.assign(m_obstacle_motions.size() + m_ends.size(), 0);
  for (SoftRow& row : m_wide_rows) {
    if (row.a.body != view.id && row.b.body != view.id) continue;
    const int other = row.a.body == view.id ? row.b.body : row.a.body;
    if (other >= 0 && other < view.id && isWide(other)) continue;  // the row was solved with `other`
    m_pushes.push_back(pushOf(row, view.id, h));
    if (row.obstacle >= 0) ++m_sharing[at(row.obstacle)];
    for (int k = 0; k < 2 && row.obstacle < 0 && m_pushes.back().p_other->nodes[k] >= 0; ++k) {
      ++m_sharing[sharedBy(*m_pushes.back().p_other, k)];
    }
  }
}

// Returns the index in m_sharing for a node of another body.
std::size_t SoftWorld::sharedBy(const SoftPoint& point, int which) const {
  const auto view = std::lower_bound(m_views.begin(), m_views.end(), point.body,
                                     [](const SoftView& v, int id) { return v.id < id; });
  return m_obstacle_motions.size() + at(view->ends - m_ends.data()) + at(point.nodes[which]);
}

double SoftWorld::yieldOf(const SoftPush& push, double h) const {
  const SoftRow& row = *push.p_row;
  double sum = 0;
  if (row.obstacle >= 0) {
    const SoftObstacleMotion& motion = m_obstacle_motions[at(row.obstacle)];
    const double turn = motion.inverse_inertia * lengthSquared(row.lever);
    sum = m_sharing[at(row.obstacle)] * (motion.inverse_mass + turn);
  }
  for (int k = 0; k < 2 && row.obstacle < 0 && push.p_other->nodes[k] >= 0; ++k) {
    const SoftNode& node = m_bodies[at(push.p_other->body)].nodes[at(push.p_other->nodes[k])];
    const double weight = push.p_other->weights[k];
    if (!node.is_pinned) sum += weight * weight * m_sharing[sharedBy(*push.p_other, k)] / node.mass;
  }
  return h * h * sum;
}

// Applies the impulse of a push to the other side's nodes. (recordRow() applies impulses to obstacles.)
void SoftWorld::pushOthers(const SoftPush& push, double h) {
  const SoftRow& row = *push.p_row;
  if (row.obstacle >= 0) return;
  const Vec2 impulse = -push.sign * h * (row.forces[0] * row.axes[0] + row.forces[1] * row.axes[1]);
  SoftBody& other = m_bodies[at(push.p_other->body)];
  for (int k = 0; k < 2 && push.p_other->nodes[k] >= 0; ++k) {
    SoftNode& node = other.nodes[at(push.p_other->nodes[k])];
    if (!node.is_pinned) node.velocity += push.p_other->weights[k] / node.mass * impulse;
  }
}

// Does one iteration of a wide body. Returns false if there is no solution.
bool SoftWorld::iterateWide(int id, double h) {
  SoftBody& body = m_bodies[at(id)];
  SoftElastic& elastic = m_elastics[at(id)];
  ++m_counters.iterations;
  elastic.assemble(body, true);
  for (SoftPush& push : m_pushes) {
    const double factor = push.p_row->is_attachment ? kAttachmentStiffness : kContactStiffness;
    push.stiffness = 1 / (1 / (factor * elastic.stiffnessOf(push.p_own->nodes[0])) + yieldOf(push, h));
  }
  for (SoftPush& push : m_pushes) {
    choose(push, apartOf(push, body, elastic));
    addTo(elastic, push);
  }
  bool is_settled = false;
  if (!elastic.solveWide(body, m_pushes.empty(), is_settled)) return false;
  if (!is_settled) ++m_counters.unconverged;
  for (SoftPush& push : m_pushes) {
    const Vec2 change = push.sign * changeOf(elastic, *push.p_own);
    for (int axis = 0; axis < 2; ++axis) {
      push.p_row->forces[axis] = push.force[axis] - push.yield[axis] * dot(push.p_row->axes[axis], change);
    }
  }
  return elastic.apply(body, elastic.change()) <= kFarthest;
}

void SoftWorld::solveWide(const SoftView& view, double h, std::span<SoftObstacle> obstacles) {
  const int id = view.id;
  SoftBody& body = m_bodies[at(id)];
  SoftElastic& elastic = m_elastics[at(id)];
  gatherPushes(view, h);
  elastic.begin(body, h, m_gravity, true);
  for (int i = 0; i < kWideIterations; ++i) {
    for (SoftPush& push : m_pushes) {
      if (i > 0) limit(push, apartOf(push, body, elastic));
    }
    if (iterateWide(id, h)) continue;
    freeze(id);
    elastic.revert(body);
    return;
  }
  for (SoftPush& push : m_pushes) {
    recordRow(*push.p_row, h, obstacles);
    pushOthers(push, h);
    limit(push, apartOf(push, body, elastic));
  }
  stopWide(id, h, obstacles);
  elastic.finish(body);
  if (limitEnergy(id)) stopWide(id, h, obstacles);
}

void SoftWorld::stopWide(int id, double h, std::span<SoftObstacle> obstacles) {
  const SoftBody& body = m_bodies[at(id)];
  m_stop_patches.clear();
  appendPatches(body.nodes, m_elastics[at(id)].starts().data(), body.radius, m_stop_patches);
  for (SoftPose& pose : m_poses) {
    pose.velocity = m_obstacle_motions[at(pose.index)].velocity;
    pose.spin = m_obstacle_motions[at(pose.index)].spin;
    const bool is_held = std::any_of(m_wide_rows.begin(), m_wide_rows.end(), [&](const SoftRow& row) {
      return row.is_attachment && row.a.body == id && row.obstacle == pose.index;
    });
    for (std::size_t i = 0; i < m_stop_patches.size() && !is_held; ++i) {
      if (!mayMeet(m_stop_patches[i], body, pose, h)) continue;
      const int begin = static_cast<int>(i) * kSoftPatch, nodes = static_cast<int>(body.nodes.size());
      for (int node = begin; node < std::min(begin + kSoftPatch, nodes); ++node) {
        if (!body.nodes[at(node)].is_pinned) stopNode(id, node, pose, h, obstacles[at(pose.index)]);
      }
    }
  }
}

}  // namespace naiad::physics
