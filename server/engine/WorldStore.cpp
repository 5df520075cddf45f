#include "WorldStore.h"

#include <algorithm>

namespace df {

namespace {

constexpr FixedBox kCharacterBox{{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}};
constexpr std::uint16_t kWhileInWorld = WorldStore::kInWorld | WorldStore::kMarked | WorldStore::kBlocked |
                                        WorldStore::kReported | WorldStore::kFollowed;

}  // namespace

WorldStore::Slot WorldStore::take(Object* p_o, bool heap) {
  Slot s = 0;
  if (m_free.empty() || m_updates - m_free.front().since < kRest) {
    s = static_cast<Slot>(m_objects.size());
    m_positions.emplace_back();
    m_velocities.emplace_back();
    m_accelerations.emplace_back();
    m_flags.push_back(0);
    m_solidness.push_back(HARD);
    m_boxes.push_back(kCharacterBox);
    m_altitudes.push_back(0);
    m_generations.push_back(1);
    m_orders.push_back(0);
    m_order_indices.push_back(0);
    m_objects.push_back(nullptr);
  } else {
    s = m_free.front().slot;
    m_free.pop_front();
  }
  m_positions[s] = {};
  m_velocities[s] = {};
  m_accelerations[s] = {};
  // A slot that changed hands within a tick is in the list of changes already.
  m_flags[s] = static_cast<std::uint16_t>((m_flags[s] & kDirty) | kActive | kVisible | (heap ? kHeap : 0));
  m_solidness[s] = HARD;
  m_boxes[s] = kCharacterBox;
  m_altitudes[s] = 2;
  m_objects[s] = p_o;
  retain();
  return s;
}

void WorldStore::give(Slot s) {
  if (++m_generations[s] == 0) m_generations[s] = 1;
  m_objects[s] = nullptr;
  m_flags[s] &= kDirty;
  m_free.push_back({s, m_updates});
  release();
}

void WorldStore::enter(Slot s) {
  m_flags[s] |= kInWorld;
  m_orders[s] = m_next_order++;
  m_order_indices[s] = static_cast<std::uint32_t>(m_order_list.size());
  m_order_list.push_back(s);
  ++m_in_world;
  file(s);
  touch(s);
}

void WorldStore::leave(Slot s) {
  if (!has(s, kInWorld)) return;
  if (m_watched && has(s, kReported)) m_vanished.push_back(key(s));
  m_flags[s] &= static_cast<std::uint16_t>(~kWhileInWorld);
  m_grid.remove(s);
  if (++m_generations[s] == 0) m_generations[s] = 1;
  m_order_list[m_order_indices[s]] = kNoSlot;
  ++m_gaps;
  --m_in_world;
  closeGaps();
}

void WorldStore::closeGaps() {
  if (m_walks > 0 || m_gaps < 32 || m_gaps * 2 < m_order_list.size()) return;
  std::erase(m_order_list, kNoSlot);
  for (std::size_t i = 0; i < m_order_list.size(); ++i) {
    m_order_indices[m_order_list[i]] = static_cast<std::uint32_t>(i);
  }
  m_gaps = 0;
}

void WorldStore::file(Slot s) {
  if (collides(s)) {
    m_grid.put(s, worldBox(s, m_positions[s]));
  } else {
    m_grid.remove(s);
  }
}

void WorldStore::setPosition(Slot s, FixedVector position) {
  if (m_positions[s] == position) return;
  m_positions[s] = position;
  if (collides(s)) m_grid.put(s, worldBox(s, position));
  touch(s);
}

void WorldStore::setVelocity(Slot s, FixedVector velocity) {
  if (m_velocities[s] == velocity) return;
  m_velocities[s] = velocity;
  m_flags[s] &= static_cast<std::uint16_t>(~kBlocked);  // whether the new one is blocked is not known yet
  touch(s);
}

void WorldStore::setAcceleration(Slot s, FixedVector acceleration) {
  if (m_accelerations[s] == acceleration) return;
  m_accelerations[s] = acceleration;
  touch(s);
}

void WorldStore::setBox(Slot s, FixedBox box) {
  if (m_boxes[s] == box) return;
  m_boxes[s] = box;
  file(s);
  touch(s);
}

void WorldStore::setSolidness(Slot s, Solidness solidness) {
  if (m_solidness[s] == solidness) return;
  m_solidness[s] = solidness;
  file(s);
  touch(s);
}

void WorldStore::setAltitude(Slot s, int altitude) {
  if (m_altitudes[s] == altitude) return;
  m_altitudes[s] = static_cast<std::uint8_t>(altitude);
  touch(s);
}

void WorldStore::settle(Slot s, FixedVector velocity, bool blocked) {
  const bool was_blocked = has(s, kBlocked);
  // The velocity of a blocked Object shows nowhere: gravity on something that lies still is no change.
  const bool shows = was_blocked != blocked || (!blocked && m_velocities[s] != velocity);
  m_velocities[s] = velocity;
  if (was_blocked != blocked) m_flags[s] ^= kBlocked;
  if (shows) touch(s);
}

void WorldStore::set(Slot s, Flag flag, bool on) {
  if (has(s, flag) == on) return;
  m_flags[s] ^= flag;
  if (flag == kActive) file(s);
  if ((flag & (kActive | kVisible | kNoSoft | kBlocked)) != 0) touch(s);
}

void WorldStore::touching(const FixedBox& box, Slot self, std::vector<ObjectKey>& out) const {
  m_candidates.clear();
  m_grid.query(box, m_candidates);
  std::erase_if(m_candidates,
                [&](Slot s) { return s == self || !intersects(worldBox(s, m_positions[s]), box); });
  std::sort(m_candidates.begin(), m_candidates.end(),
            [this](Slot a, Slot b) { return m_orders[a] < m_orders[b]; });
  for (Slot s : m_candidates) out.push_back(key(s));
}

void WorldStore::setWatched(bool watched) {
  if (m_watched == watched) return;
  m_watched = watched;
  for (Slot s : m_dirty) m_flags[s] &= static_cast<std::uint16_t>(~kDirty);
  m_dirty.clear();
  m_vanished.clear();
  for (Slot s : m_order_list) {
    if (s == kNoSlot) continue;
    m_flags[s] &= static_cast<std::uint16_t>(~kReported);
    touch(s);
  }
}

void WorldStore::note(Slot s) {
  if (has(s, kDirty)) return;
  m_flags[s] |= kDirty;
  m_dirty.push_back(s);
}

void WorldStore::report(WorldView& view) {
  for (Slot s : m_dirty) {
    m_flags[s] &= static_cast<std::uint16_t>(~kDirty);
    if (!has(s, kInWorld)) continue;
    m_flags[s] |= kReported;
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
  f.order = m_orders[s];
  f.position = m_positions[s];
  // An inactive Object stands, whatever its velocity.
  if (has(s, kActive) && !has(s, kBlocked)) {
    f.velocity = m_velocities[s];
    if (isVelocity(f.velocity + m_accelerations[s])) f.acceleration = m_accelerations[s];
  }
  f.box = m_boxes[s];
  f.solidness = m_solidness[s];
  f.no_soft = has(s, kNoSoft);
  f.shown = has(s, kActive) && has(s, kVisible);
  f.altitude = m_altitudes[s];
  return f;
}

}  // namespace df
