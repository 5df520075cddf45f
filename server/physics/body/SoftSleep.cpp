#include "physics/body/SoftSleep.h"

#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr int kStillTicks = 30;  // ticks of stillness until it sleeps: a second

bool maySleep(const SoftEntry& entry) {
  return entry.is_in && (entry.is_asleep ||
                         (entry.still >= kStillTicks && !entry.is_loaded && entry.attached_nodes.empty() &&
                          entry.grab.attachment < 0 && entry.surrounding != 0));
}

}  // namespace

void SoftSleep::begin(int id_limit) {
  m_reaches.assign(at(id_limit), {});
  m_sleeps.assign(at(id_limit), 0);
}

bool SoftSleep::areNear(SoftTable& table, int a, int b) const {
  const Vec2 offset = table.entry(a).centre - table.entry(b).centre;
  const Vec2 reach = m_reaches[at(a)] + m_reaches[at(b)];
  return std::fabs(offset.x) <= reach.x && std::fabs(offset.y) <= reach.y;
}

void SoftSleep::wakeNeighbours(SoftTable& table) const {
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (int id = 0; id < table.idLimit(); ++id) {
      if (!table.entry(id).is_in || !table.entry(id).is_asleep) continue;
      for (int other = 0; other < table.idLimit(); ++other) {
        const bool is_awake = other != id && table.entry(other).is_in && !table.entry(other).is_asleep;
        if (!is_awake || !areNear(table, id, other)) continue;
        table.wake(id);
        is_changed = true;
        break;
      }
    }
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
  for (int id = 0; id < table.idLimit(); ++id) m_sleeps[at(id)] = maySleep(table.entry(id)) ? 1 : 0;
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (int id = 0; id < table.idLimit(); ++id) {
      char& sleeps = m_sleeps[at(id)];
      for (int other = 0; other < table.idLimit() && sleeps != 0; ++other) {
        const bool keeps_awake =
            other != id && table.entry(other).is_in && m_sleeps[at(other)] == 0 && areNear(table, id, other);
        if (!keeps_awake) continue;
        sleeps = 0;
        is_changed = true;
      }
    }
  }
  for (int id = 0; id < table.idLimit(); ++id) {
    SoftEntry& entry = table.entry(id);
    if (m_sleeps[at(id)] == 0 || entry.is_asleep) continue;
    SoftBody body = table.world().body(id);
    for (SoftNode& node : body.nodes) node.velocity = {};
    table.set(id, body);
    table.measure(id);
    entry.is_asleep = true;
  }
}

}  // namespace naiad::physics
