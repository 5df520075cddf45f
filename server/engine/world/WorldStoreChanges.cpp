// The part of WorldStore that reports what has changed.

#include <algorithm>

#include "engine/world/WorldStore.h"

namespace df {

void WorldStore::setWatched(bool watched) {
  if (m_watched == watched) return;
  m_watched = watched;
  for (Slot s : m_dirty) m_cards[s].flags &= static_cast<std::uint32_t>(~kDirty);
  m_dirty.clear();
  m_vanished.clear();
  for (Slot s : m_order_list) {
    if (s == kNoSlot) continue;
    m_cards[s].flags &= static_cast<std::uint32_t>(~kReported);
    touch(s);
  }
}

void WorldStore::flagChanged(Slot s) {
  if (has(s, kDirty)) return;
  m_cards[s].flags |= kDirty;
  m_dirty.push_back(s);
}

void WorldStore::report(WorldView& view) {
  for (Slot s : m_dirty) {
    m_cards[s].flags &= static_cast<std::uint32_t>(~kDirty);
    if (!has(s, kInWorld)) continue;
    m_cards[s].flags |= kReported;
    view.changed.push_back(facts(s));
  }
  m_dirty.clear();
  std::sort(view.changed.begin(), view.changed.end(),
            [](const ObjectFacts& a, const ObjectFacts& b) { return a.order < b.order; });
  view.vanished.insert(view.vanished.end(), m_vanished.begin(), m_vanished.end());
  m_vanished.clear();
}

ObjectFacts WorldStore::facts(Slot s) const {
  ObjectFacts f;
  f.key = key(s);
  f.order = m_cards[s].order;
  f.position = m_positions[s];
  // An inactive Object does not move, whatever its velocity.
  if (has(s, kActive) && !isBlocked(s)) {
    f.velocity = m_velocities[s];
    if (isVelocity(f.velocity + m_accelerations[s])) f.acceleration = m_accelerations[s];
    // A body's velocity is that of this moment. In the next tick it moves by half a tick's acceleration more.
    if (has(s, kBody)) f.velocity = f.velocity + FixedVector{f.acceleration.x >> 1, f.acceleration.y >> 1};
  }
  f.box = m_boxes[s];
  f.solidness = m_cards[s].solidness;
  f.no_soft = has(s, kNoSoft);
  f.shown = has(s, kActive) && has(s, kVisible);
  f.on_view = has(s, kOnView);
  f.altitude = m_cards[s].altitude;
  return f;
}

}  // namespace df
