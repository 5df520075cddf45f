#include "physics/soft/SoftWorld.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

void SoftWorld::start(int id) {
  m_elastics[at(id)].prepare(m_bodies[at(id)]);
  m_states[at(id)] = {};
  m_states[at(id)].exists = true;
}

int SoftWorld::add(const SoftBody& body) {
  if (!isValid(body)) return -1;
  int id = 0;
  while (id < idLimit() && m_states[at(id)].exists) ++id;
  if (id == idLimit()) {
    m_bodies.emplace_back();
    m_elastics.emplace_back();
    m_states.emplace_back();
  }
  m_bodies[at(id)] = body;
  start(id);
  return id;
}

bool SoftWorld::set(int id, const SoftBody& body) {
  if (!exists(id) || !isValid(body)) return false;
  m_bodies[at(id)] = body;
  start(id);
  return true;
}

bool SoftWorld::remove(int id) {
  if (!exists(id)) return false;
  m_states[at(id)].exists = false;
  std::erase_if(m_touched, [id](const Touch& touch) { return touch.isOf(id); });
  for (SoftAttachment& attachment : m_attachments) {
    if (attachment.body == id) attachment.body = -1;
  }
  return true;
}

bool SoftWorld::setForce(int id, int node, Vec2 force) {
  if (!exists(id) || node < 0 || at(node) >= m_bodies[at(id)].nodes.size() || !isSmallSoft(force))
    return false;
  if (m_bodies[at(id)].nodes[at(node)].force == force) return true;
  m_bodies[at(id)].nodes[at(node)].force = force;
  m_elastics[at(id)].forgetHistory();
  m_states[at(id)].is_fresh = true;
  return true;
}

bool SoftWorld::pin(int id, int node, bool is_pinned) {
  if (!exists(id) || node < 0 || at(node) >= m_bodies[at(id)].nodes.size()) return false;
  m_bodies[at(id)].nodes[at(node)].is_pinned = is_pinned;
  m_bodies[at(id)].nodes[at(node)].velocity = {};
  if (!isWide(id) || m_states[at(id)].is_frozen) {
    start(id);
    return true;
  }
  m_elastics[at(id)].setPinned(node, is_pinned);  // the body needs no other change
  m_states[at(id)].is_fresh = true;
  return true;
}

bool SoftWorld::applyImpulse(int id, int node, Vec2 impulse) {
  if (!exists(id) || node < 0 || at(node) >= m_bodies[at(id)].nodes.size()) return false;
  SoftNode& hit = m_bodies[at(id)].nodes[at(node)];
  const Vec2 velocity = hit.velocity + impulse / hit.mass;
  if (!isSmallSoft(velocity)) return false;
  if (hit.is_pinned) return true;
  hit.velocity = velocity;
  m_elastics[at(id)].forgetHistory();
  m_states[at(id)].is_fresh = true;
  return true;
}

bool SoftWorld::setGravity(Vec2 gravity) {
  if (!isSmallSoft(gravity)) return false;
  m_gravity = gravity;
  for (State& state : m_states) state.is_fresh = true;
  for (SoftElastic& elastic : m_elastics) elastic.forgetHistory();
  return true;
}

bool SoftWorld::setSubsteps(int substeps) {
  if (substeps < 1 || substeps > 64) return false;
  m_substeps = substeps;
  return true;
}

int SoftWorld::attach(const SoftAttachment& attachment) {
  if (!exists(attachment.body) || attachment.node < 0 ||
      at(attachment.node) >= m_bodies[at(attachment.body)].nodes.size() || !isSmallSoft(attachment.anchor)) {
    return -1;
  }
  int id = 0;
  while (at(id) < m_attachments.size() && m_attachments[at(id)].body >= 0) ++id;
  if (at(id) == m_attachments.size()) m_attachments.emplace_back();
  m_attachments[at(id)] = attachment;
  return id;
}

bool SoftWorld::detach(int attachment) {
  if (attachment < 0 || at(attachment) >= m_attachments.size() || m_attachments[at(attachment)].body < 0) {
    return false;
  }
  m_states[at(m_attachments[at(attachment)].body)].is_fresh = true;
  m_attachments[at(attachment)].body = -1;
  return true;
}

void SoftWorld::freeze(int id) {
  m_states[at(id)].is_frozen = true;
  m_has_frozen = true;
  ++m_counters.quarantined;
}

// Moves the place along with the body, so that offsets stay small and exact.
void SoftWorld::recentre(int id) {
  constexpr double kFar = 1024;  // metric cells: up to this, offsets have 13 digits after the decimal point
  SoftBody& body = m_bodies[at(id)];
  const Vec2 first = body.nodes[0].offset;
  if (std::fabs(first.x) < kFar && std::fabs(first.y) < kFar) return;
  const Vec2 by = {df::math::rounded(first.x), df::math::rounded(first.y)};
  const double before = energyOf(body, m_gravity);
  body.place = body.place + by;
  for (SoftNode& node : body.nodes) node.offset -= by;
  m_elastics[at(id)].shift(-by);
  m_states[at(id)].budget += energyOf(body, m_gravity) - before;
}

SoftStatus SoftWorld::step(double dt, std::span<SoftObstacle> obstacles) {
  if (!(dt > 0 && dt <= 1e6)) return SoftStatus::kRefused;
  for (const SoftObstacle& obstacle : obstacles) {
    if (!isValid(obstacle)) return SoftStatus::kRefused;
  }
  ++m_counters.steps;
  m_has_frozen = false;
  m_touching.clear();
  for (SoftObstacle& obstacle : obstacles) {
    obstacle.impulse = obstacle.displacement = {};
    obstacle.angular_impulse = obstacle.turn = 0;
  }
  m_obstacle_motions.resize(obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const SoftObstacle& o = obstacles[i];
    m_obstacle_motions[i] = {o.velocity, o.spin, o.inverse_mass, o.inverse_inertia};
  }
  for (int id = 0; id < idLimit(); ++id) {
    if (!isLive(id)) continue;
    recentre(id);
    State& state = m_states[at(id)];
    if (state.is_fresh) state.budget = energyOf(m_bodies[at(id)], m_gravity);
    state.is_fresh = false;
  }
  const double wanted = std::ceil(dt * m_substeps);
  const int substeps = wanted < 64 ? static_cast<int>(wanted) : 64;
  for (int i = 0; i < substeps; ++i) substep(dt / substeps, obstacles);
  publish();
  return m_has_frozen ? SoftStatus::kQuarantined : SoftStatus::kDone;
}

bool SoftWorld::isOut(const Touch& touch) const {
  const State& state = m_states[at(touch.body())];
  return state.exists && (state.is_out || (touch.isSoft() && m_states[at(touch.other())].is_out));
}

bool SoftWorld::isTouching(int id) const {
  return std::any_of(m_touched.begin(), m_touched.end(), [id](const Touch& touch) { return touch.isOf(id); });
}

bool SoftWorld::isTouching(int id, int obstacle) const {
  return std::any_of(m_touched.begin(), m_touched.end(), [&](const Touch& touch) {
    return touch.body() == id && !touch.isSoft() && touch.other() == obstacle;
  });
}

void SoftWorld::publish() {
  m_events.clear();
  const auto has = [](const std::vector<Touch>& touches, const Touch& one) {
    return std::any_of(touches.begin(), touches.end(), [&](const Touch& t) { return t.key == one.key; });
  };
  for (const Touch& touch : m_touching) {
    if (!has(m_touched, touch)) m_events.push_back(touch.event(true));
  }
  const std::size_t touching = m_touching.size();
  for (const Touch& touch : m_touched) {
    if (isOut(touch)) {
      m_touching.push_back(touch);  // these contacts continue, so they must not begin again later
    } else if (!std::binary_search(m_touching.begin(),
                                   m_touching.begin() + static_cast<std::ptrdiff_t>(touching), touch,
                                   [](const Touch& a, const Touch& b) { return a.key < b.key; })) {
      m_events.push_back(touch.event(false));
    }
  }
  m_touched.swap(m_touching);
}

}  // namespace naiad::physics
