#include "engine/world/WorldStore.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace df {

namespace {

constexpr std::uint32_t kWhileInWorld = WorldStore::kInWorld | WorldStore::kMarked | WorldStore::kLookCached |
                                        WorldStore::kReported | WorldStore::kFollowed;
// An Object with one of these flags is neither a flier nor a walker (UpdateMasks).
constexpr std::uint32_t kOptions =
    WorldStore::kSwept | WorldStore::kPrecise | WorldStore::kRestContacts | WorldStore::kMayMoveOut;
constexpr std::uint32_t kSpecial = WorldStore::kFollowed | (WorldStore::kLayers ? kOptions : 0);

}  // namespace

WorldStore::Slot WorldStore::allocateSlot(Object* p_o, bool heap) {
  Slot s = 0;
  if (m_free.empty() || m_updates - m_free.front().since < kSlotReuseDelay) {
    s = static_cast<Slot>(m_cards.size());
    m_positions.emplace_back();
    m_velocities.emplace_back();
    m_accelerations.emplace_back();
    m_boxes.push_back(kCharacterBox);
    m_cards.emplace_back();
    m_profiles.emplace_back();
  } else {
    s = m_free.front().slot;
    m_free.pop_front();
  }
  m_positions[s] = {};
  m_velocities[s] = {};
  m_accelerations[s] = {};
  // Keeps kDirty: a slot that is reused within a tick is in the list of changes already.
  m_cards[s].flags =
      static_cast<std::uint32_t>((m_cards[s].flags & kDirty) | kActive | kVisible | (heap ? kHeap : 0u));
  m_cards[s].solidness = HARD;
  m_boxes[s] = kCharacterBox;
  m_cards[s].altitude = 2;
  m_cards[s].p_object = p_o;
  retain();
  return s;
}

void WorldStore::freeSlot(Slot s) {
  if (++m_cards[s].generation == 0) m_cards[s].generation = 1;
  m_cards[s].p_object = nullptr;
  m_profiles[s] = {};
  if (has(s, kPrecise)) --m_precise;
  m_cards[s].flags &= kDirty;
  if (!m_masks.empty()) m_masks.erase(s);
  if (!m_frames.empty()) m_frames.erase(s);
  m_free.push_back({s, m_updates});
  release();
}

void WorldStore::enter(Slot s) {
  assert(!has(s, kInWorld));
  m_cards[s].flags |= kInWorld;
  m_cards[s].order = m_next_order++;
  const std::size_t index = m_order_list.size();
  m_cards[s].index = static_cast<std::uint32_t>(index);
  m_order_list.push_back(s);
  m_bits.grow(index);
  UpdateMasks::set(m_bits.consecutive, index, index > 0 && m_order_list[index - 1] + 1 == s);
  ++m_in_world;
  m_new_objects.push_back(key(s));
  file(s);
  touch(s);
}

void WorldStore::leave(Slot s) {
  if (!has(s, kInWorld)) return;
  if (m_watched && has(s, kReported)) m_vanished.push_back(key(s));
  m_cards[s].flags &= static_cast<std::uint32_t>(~kWhileInWorld);
  m_grid.remove(s);
  if (++m_cards[s].generation == 0) m_cards[s].generation = 1;
  m_order_list[m_cards[s].index] = kNoSlot;
  unmark(m_cards[s].index);
  m_bits.clear(m_cards[s].index);
  ++m_gaps;
  --m_in_world;
  closeGaps();
}

void WorldStore::closeGaps() {
  if (m_walks > 0 || m_gaps < 32 || m_gaps * 2 < m_order_list.size()) return;
  const std::size_t size = m_order_list.size();
  std::erase(m_order_list, kNoSlot);
  assert(m_order_list.size() == static_cast<std::size_t>(m_in_world));
  for (std::size_t i = 0; i < m_order_list.size(); ++i) {
    // Entries only move towards the front, so the entry that is read here has not been overwritten yet.
    const Slot s = m_order_list[i];
    const bool blocked = isBlocked(s);
    m_cards[s].index = static_cast<std::uint32_t>(i);
    UpdateMasks::set(m_bits.blocked, i, blocked);
    UpdateMasks::set(m_bits.consecutive, i, i > 0 && m_order_list[i - 1] + 1 == s);
    markSolid(s);
    classify(s);
  }
  for (std::size_t i = m_order_list.size(); i < size; ++i) {
    unmark(i);
    m_bits.clear(i);
    UpdateMasks::set(m_bits.consecutive, i, false);
  }
  m_gaps = 0;
}

// Derives the kind of turn that the Object takes in update().
void WorldStore::classify(Slot s) {
  const std::uint32_t flags = m_cards[s].flags;
  if ((flags & kInWorld) == 0) return;
  const bool moves = m_velocities[s] != FixedVector{};
  const bool accelerates = m_accelerations[s] != FixedVector{};
  const bool acts = (flags & (kActive | kBody)) == kActive;
  const bool turns = acts && (moves || accelerates || testsAtRest(s));
  const bool plain = turns && moves && !accelerates && (flags & kSpecial) == 0;
  const bool spectral = m_cards[s].solidness == SPECTRAL;
  const std::size_t i = m_cards[s].index;
  mark(m_bits.handlers, m_handlers, i, handlesEvents(s) && !spectral);
  UpdateMasks::set(m_bits.turns, i, turns);
  // A blocked Object is not a flier, because its next turn has to clear the bit.
  UpdateMasks::set(m_bits.fliers, i, plain && spectral && !isBlocked(s));
  UpdateMasks::set(m_bits.walkers, i, plain && !spectral && !(kLayers && m_all_swept));
}

void WorldStore::mark(UpdateMasks::Words& row, int& count, std::size_t index, bool on) {
  if (UpdateMasks::get(row, index) == on) return;
  UpdateMasks::set(row, index, on);
  count += on ? 1 : -1;
}

// Updates the Object's bits in the sets of solid Objects.
void WorldStore::markSolid(Slot s) {
  if (!has(s, kInWorld)) return;
  const bool is_solid = collides(s);
  mark(m_bits.hards, m_hards, m_cards[s].index, is_solid && m_cards[s].solidness == HARD);
  mark(m_bits.softs, m_softs, m_cards[s].index, is_solid && m_cards[s].solidness == SOFT);
}

// Removes an entry that becomes a gap from the sets that are counted.
void WorldStore::unmark(std::size_t index) {
  mark(m_bits.handlers, m_handlers, index, false);
  mark(m_bits.hards, m_hards, index, false);
  mark(m_bits.softs, m_softs, index, false);
}

void WorldStore::setAllSwept(bool all_swept) {
  if (m_all_swept == all_swept) return;
  m_all_swept = all_swept;
  for (Slot s : m_order_list) {
    if (s != kNoSlot) classify(s);
  }
}

void WorldStore::file(Slot s) {
  if (collides(s)) {
    m_grid.file(s);
  } else {
    m_grid.remove(s);
  }
  markSolid(s);
  classify(s);
}

void WorldStore::setPosition(Slot s, FixedVector position) {
  if (m_positions[s] == position) return;
  m_positions[s] = position;
  if (m_grid.contains(s)) m_grid.refile(s);
  touch(s);
}

void WorldStore::setVelocity(Slot s, FixedVector velocity) {
  const FixedVector before = m_velocities[s];
  if (before == velocity) return;
  m_velocities[s] = velocity;
  // Whether the new velocity is blocked is not known yet.
  const bool was_blocked = has(s, kInWorld) && isBlocked(s);
  if (was_blocked) UpdateMasks::set(m_bits.blocked, m_cards[s].index, false);
  if (was_blocked || before == FixedVector{} || velocity == FixedVector{}) classify(s);
  touch(s);
}

void WorldStore::setAcceleration(Slot s, FixedVector acceleration) {
  if (m_accelerations[s] == acceleration) return;
  m_accelerations[s] = acceleration;
  classify(s);
  touch(s);
}

void WorldStore::setBox(Slot s, FixedBox box) {
  if (m_boxes[s] == box) return;
  m_boxes[s] = box;
  m_boxes_off = m_boxes_off || !intersects(box, {});
  file(s);
  touch(s);
}

void WorldStore::setSolidness(Slot s, Solidness solidness) {
  if (m_cards[s].solidness == solidness) return;
  m_cards[s].solidness = solidness;
  if (solidness == SOFT) m_has_had_soft = true;
  file(s);
  touch(s);
}

void WorldStore::setAltitude(Slot s, int altitude) {
  if (m_cards[s].altitude == altitude) return;
  m_cards[s].altitude = static_cast<std::uint8_t>(altitude);
  touch(s);
}

void WorldStore::setMask(Slot s, std::optional<Mask> mask) {
  m_masks.erase(s);
  if (mask) m_masks.emplace(s, std::move(*mask));
}

void WorldStore::setFrames(Slot s, std::shared_ptr<const naiad::Look> p_look) {
  set(s, kFrames, p_look != nullptr);
  if (p_look == nullptr) {
    m_frames.erase(s);
  } else {
    m_frames[s] = std::move(p_look);
  }
}

const std::shared_ptr<const naiad::Look>& WorldStore::frames(Slot s) const {
  static const std::shared_ptr<const naiad::Look> kNone;
  const auto found = m_frames.find(s);
  return found == m_frames.end() ? kNone : found->second;
}

const Mask* WorldStore::spriteMask(Slot s) const {
  return spriteMaskOf(*m_cards[s].p_object);
}

void WorldStore::settleChanged(Slot s, FixedVector velocity, bool blocked) {
  const bool was_blocked = isBlocked(s);
  // Hosts do not see the velocity of a blocked Object, so gravity on an Object at rest is not a change.
  const bool shows = was_blocked != blocked || (!blocked && m_velocities[s] != velocity);
  m_velocities[s] = velocity;
  if (was_blocked != blocked) {
    UpdateMasks::set(m_bits.blocked, m_cards[s].index, blocked);
    if (m_cards[s].solidness == SPECTRAL) classify(s);
  }
  if (shows) touch(s);
}

void WorldStore::set(Slot s, Flag flag, bool on) {
  if (has(s, flag) == on) return;
  m_cards[s].flags ^= flag;
  if (flag == kActive) file(s);
  if (flag == kPrecise) m_precise += on ? 1 : -1;
  if ((flag & (kSpecial | kBody | kNoEventHandler)) != 0) classify(s);
  if ((flag & (kActive | kVisible | kNoSoft)) != 0) touch(s);
}

}  // namespace df
