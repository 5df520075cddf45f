#include "physics/body/SoftSleep.h"

#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr int kStillTicks = 30;  // ticks that a body must be still before it sleeps: a second

bool maySleep(const SoftEntry& entry) {
  return entry.is_asleep || (entry.still >= kStillTicks && !entry.is_loaded && entry.attached_nodes.empty() &&
                             entry.grab.attachment < 0 && entry.surrounding != 0);
}

}  // namespace

void SoftSleep::begin(int id_limit) {
  m_reaches.assign(at(id_limit), {});
}

bool SoftSleep::areNear(SoftTable& table, int a, int b) const {
  const Vec2 offset = table.entry(a).centre - table.entry(b).centre;
  const Vec2 reach = m_reaches[at(a)] + m_reaches[at(b)];
  return std::fabs(offset.x) <= reach.x && std::fabs(offset.y) <= reach.y;
}

// Finds the groups of bodies near each other. Sets m_allows to 0 for groups with a body that is rejected.
template <class Allows>
void SoftSleep::findGroups(SoftTable& table, Allows allows) {
  m_groups.reset(at(table.idLimit()));
  m_allows.assign(at(table.idLimit()), 1);
  for (int id = 0; id < table.idLimit(); ++id) {
    for (int other = 0; other < id && table.entry(id).is_in; ++other) {
      if (table.entry(other).is_in && areNear(table, id, other)) m_groups.unite(id, other);
    }
  }
  for (int id = 0; id < table.idLimit(); ++id) {
    if (table.entry(id).is_in && !allows(table.entry(id))) m_allows[at(m_groups.rootOf(id))] = 0;
  }
}

void SoftSleep::wakeNeighbours(SoftTable& table) {
  findGroups(table, [](const SoftEntry& entry) { return entry.is_asleep; });
  for (int id = 0; id < table.idLimit(); ++id) {
    const SoftEntry& entry = table.entry(id);
    if (entry.is_in && entry.is_asleep && m_allows[at(m_groups.rootOf(id))] == 0) table.wake(id);
  }
}

void SoftSleep::findLoads(SoftTable& table, std::span<const SoftObstacle> obstacles) {
  for (int id = 0; id < table.idLimit(); ++id) table.entry(id).is_loaded = false;
  for (const SoftObstacle& obstacle : obstacles) {
    if (obstacle.inverse_mass == 0 || obstacle.impulse == Vec2{}) continue;
    for (int id = 0; id < table.idLimit(); ++id) {
      SoftEntry& entry = table.entry(id);
      entry.is_loaded = entry.is_loaded || table.world().isTouching(id, obstacle.id);
    }
  }
}

void SoftSleep::update(SoftTable& table) {
  findGroups(table, maySleep);
  for (int id = 0; id < table.idLimit(); ++id) {
    SoftEntry& entry = table.entry(id);
    if (!entry.is_in || entry.is_asleep || m_allows[at(m_groups.rootOf(id))] == 0) continue;
    SoftBody body = table.world().body(id);
    for (SoftNode& node : body.nodes) node.velocity = {};
    table.set(id, body);
    table.measure(id);
    entry.is_asleep = true;
  }
}

}  // namespace naiad::physics
