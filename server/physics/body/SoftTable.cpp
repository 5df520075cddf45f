#include "physics/body/SoftTable.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace naiad::physics {

int SoftTable::add(const Object* p_object, ObjectKey key, const SoftBody& body) {
  const int id = m_world.add(body);
  if (id < 0) return -1;
  if (id >= idLimit()) m_entries.resize(static_cast<std::size_t>(id) + 1);
  SoftEntry& its = entry(id);
  its = {};
  its.key = key;
  its.p_object = p_object;
  its.made = body;
  its.mass = 0;
  for (const SoftNode& node : body.nodes) its.mass += node.mass;
  ++m_bodies->soft_bodies;
  measure(id);
  return id;
}

void SoftTable::remove(int id) {
  m_world.remove(id);
  entry(id) = {};
  --m_bodies->soft_bodies;
}

bool SoftTable::set(int id, const SoftBody& body) {
  if (!m_world.set(id, body)) return false;
  wake(id);
  return true;
}

bool SoftTable::pin(int id, int node, bool is_pinned) {
  if (!m_world.pin(id, node, is_pinned)) return false;
  wake(id);
  return true;
}

void SoftTable::measure(int id) {
  const SoftBody& body = m_world.body(id);
  SoftEntry& its = entry(id);
  double mass = 0, most = 0;
  Vec2 offset, momentum;
  for (const SoftNode& node : body.nodes) {
    mass += node.mass;
    offset += node.mass * node.offset;
    if (node.is_pinned) continue;
    momentum += node.mass * node.velocity;
    most = std::max(most, lengthSquared(node.velocity));
  }
  its.centre = body.place + offset / mass;
  its.velocity = momentum / mass;
  its.top_speed = std::sqrt(most);
}

// Restores the shape with which a frozen body was made, because its present shape may be tangled.
void SoftTable::thaw(int id) {
  SoftEntry& its = entry(id);
  if (!its.is_frozen) return;
  its.is_frozen = false;
  SoftBody body = m_world.body(id);
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    body.nodes[i].offset = its.made.nodes[i].offset;
    body.nodes[i].velocity = {};
  }
  set(id, body);
  measure(id);
}

void SoftTable::moveTo(int id, const Place& centre) {
  thaw(id);
  SoftBody body = m_world.body(id);
  body.place = body.place + (centre - entry(id).centre);
  set(id, body);
  measure(id);
}

void SoftTable::setVelocity(int id, Vec2 velocity) {
  thaw(id);
  const Vec2 change = velocity - entry(id).velocity;
  SoftBody body = m_world.body(id);
  for (SoftNode& node : body.nodes) {
    if (!node.is_pinned) node.velocity += change;
  }
  set(id, body);
  measure(id);
}

void SoftTable::syncFromStore(int id, FixedVector position, FixedVector velocity) {
  SoftEntry& its = entry(id);
  if (position != its.published_position) moveTo(id, metric().placeOf(position));
  if (velocity != its.published_velocity) setVelocity(id, metric().fromCells(Vector::fromFixed(velocity)));
  its.published_position = position;
  its.published_velocity = velocity;
}

Vec2 SoftTable::reach(int id) const {
  const SoftBody& body = m_world.body(id);
  const Vec2 middle = m_entries[static_cast<std::size_t>(id)].centre - body.place;
  Vec2 most;
  for (const SoftNode& node : body.nodes) {
    const Vec2 offset = node.offset - middle;
    most = {std::max(most.x, std::fabs(offset.x)), std::max(most.y, std::fabs(offset.y))};
  }
  return most + Vec2{body.radius, body.radius};
}

}  // namespace naiad::physics
