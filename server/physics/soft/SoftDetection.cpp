// Collision detection of a SoftWorld at the start of a sub-step: positions, and contacts that may occur.
#include <algorithm>
#include <cmath>

#include "physics/soft/SoftWorld.h"

namespace naiad::physics {

// Collects present and unimpeded positions. Freezes bodies that are out of range before others touch them.
void SoftWorld::updateViews(double h, std::span<SoftObstacle> obstacles) {
  std::size_t nodes = 0;
  for (int id = 0; id < idLimit(); ++id) nodes += m_bodies[at(id)].nodes.size();
  m_ends.resize(nodes);
  m_views.clear();
  m_patches.clear();
  std::size_t patches = 0;
  for (int id = 0; id < idLimit(); ++id) {
    if (isLive(id) && isWide(id)) patches += m_bodies[at(id)].nodes.size() / kSoftPatch + 1;
  }
  m_patches.reserve(patches);  // the vector must not move, because views point into it
  std::size_t used = 0;
  for (int id = 0; id < idLimit(); ++id) {
    if (!isLive(id)) continue;
    const SoftBody& body = m_bodies[at(id)];
    SoftView view;
    view.body = &body, view.id = id, view.ends = &m_ends[used];
    Vec2 lower = {1e300, 1e300}, upper = {-1e300, -1e300};
    bool is_near = true;
    for (const SoftNode& node : body.nodes) {
      const Vec2 acceleration = m_gravity + node.force / node.mass;
      const Vec2 displacement = h * (node.is_pinned ? node.velocity : node.velocity + h * acceleration);
      is_near = is_near && std::fabs(displacement.x) <= kFarthest && std::fabs(displacement.y) <= kFarthest;
      const Vec2 end = m_ends[used++] = node.offset + displacement;
      lower = {std::min({lower.x, node.offset.x, end.x}), std::min({lower.y, node.offset.y, end.y})};
      upper = {std::max({upper.x, node.offset.x, end.x}), std::max({upper.y, node.offset.y, end.y})};
    }
    if (!is_near) {
      freeze(id);
      continue;
    }
    const double thick = (1 + kSoftSkin) * body.radius;
    view.lower = lower - Vec2{thick, thick}, view.upper = upper + Vec2{thick, thick};
    if (isWide(id)) {
      const std::size_t begin = m_patches.size();
      appendPatches(body.nodes, view.ends, thick, m_patches);
      view.patches = std::span<const SoftPatch>(m_patches).subspan(begin);
    }
    m_views.push_back(view);
  }
  m_poses.resize(obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const SoftObstacle& o = obstacles[i];
    double reach = 0;
    for (const ConvexShape& shape : o.shapes) reach = std::max(reach, shape.reach + shape.radius);
    m_poses[i] = {&o,
                  static_cast<int>(i),
                  o.place + o.displacement,
                  turned(o.rotation, o.turn),
                  m_obstacle_motions[i].velocity,
                  m_obstacle_motions[i].spin,
                  reach};
  }
}

void SoftWorld::findRows(double h, std::span<SoftObstacle> obstacles) {
  m_rows.clear();
  for (std::size_t i = 0; i < m_views.size(); ++i) {
    for (const SoftPose& pose : m_poses) findContacts(m_views[i], pose, h, m_rows);
    if (!m_crowd.findContacts(m_views, i, m_rows)) ++m_counters.crowded;
  }
  findAttachments(obstacles);
  for (SoftRow& row : m_rows) {
    const auto before = std::lower_bound(m_earlier.begin(), m_earlier.end(), row.key,
                                         [](const SoftRow& a, std::uint64_t key) { return a.key < key; });
    if (before == m_earlier.end() || before->key != row.key) continue;
    row.forces[0] = before->forces[0], row.forces[1] = before->forces[1];
  }
}

void SoftWorld::findAttachments(std::span<SoftObstacle> obstacles) {
  for (std::size_t i = 0; i < m_attachments.size(); ++i) {
    const SoftAttachment& held = m_attachments[i];
    if (held.body < 0 || !isLive(held.body)) continue;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      if (obstacles[k].id != held.obstacle) continue;
      // A body attached to an obstacle does not collide with it, like bodies joined by joints.
      std::erase_if(m_rows, [&](const SoftRow& row) {
        return row.obstacle == static_cast<int>(k) && !row.is_attachment && row.a.body == held.body;
      });
      const SoftBody& body = m_bodies[at(held.body)];
      SoftRow row;
      row.a = {held.body, {held.node, -1}, {1, 0}};
      row.obstacle = static_cast<int>(k);
      row.lever = m_poses[k].rotation * held.anchor;
      row.axes[0] = {1, 0}, row.axes[1] = {0, 1};
      const Vec2 off = body.nodes[at(held.node)].offset - (m_poses[k].place - body.place) - row.lever;
      row.gaps[0] = off.x, row.gaps[1] = off.y;
      row.is_attachment = true;
      row.key = ~static_cast<std::uint64_t>(i);
      m_rows.push_back(row);
    }
  }
}

}  // namespace naiad::physics
