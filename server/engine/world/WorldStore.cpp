#include "engine/world/WorldStore.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "engine/collision/GridSteps.h"
#include "engine/world/Object.h"

namespace df {

namespace {

constexpr std::uint32_t kWhileInWorld =
    WorldStore::kInWorld | WorldStore::kMarked | WorldStore::kReported | WorldStore::kFollowed;
constexpr std::size_t kManyFound = 12;  // too many to sort them one by one
// A turn with one of these has more to it than position += velocity.
constexpr std::uint32_t kOptions =
    WorldStore::kSwept | WorldStore::kPrecise | WorldStore::kRestContacts | WorldStore::kMayMoveOut;
constexpr std::uint32_t kSpecial = WorldStore::kFollowed | (WorldStore::kLayers ? kOptions : 0);

// Both coordinates at once, in a register of any processor that has such (GCC and Clang know the notation).
using Two = Fixed __attribute__((vector_size(16)));

Two load(FixedVector v) {
  return Two{v.x, v.y};
}

void setBit(std::vector<std::uint64_t>& bits, std::size_t i, bool on) {
  const std::uint64_t bit = std::uint64_t{1} << (i % 64);
  std::uint64_t& word = bits[i / 64];
  word = on ? word | bit : word & ~bit;
}

}  // namespace

WorldStore::Slot WorldStore::take(Object* p_o, bool heap) {
  Slot s = 0;
  if (m_free.empty() || m_updates - m_free.front().since < kRest) {
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
  // A slot that changed hands within a tick is in the list of changes already.
  m_cards[s].flags =
      static_cast<std::uint32_t>((m_cards[s].flags & kDirty) | kActive | kVisible | (heap ? kHeap : 0u));
  m_cards[s].solidness = HARD;
  m_boxes[s] = kCharacterBox;
  m_cards[s].altitude = 2;
  m_cards[s].p_object = p_o;
  retain();
  return s;
}

void WorldStore::give(Slot s) {
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
  m_cards[s].flags |= kInWorld;
  m_cards[s].order = m_next_order++;
  const std::size_t index = m_order_list.size();
  m_cards[s].index = static_cast<std::uint32_t>(index);
  m_order_list.push_back(s);
  if (index % 64 == 0) {
    for (auto* p_bits : {&m_turns, &m_fliers, &m_walkers, &m_sequels, &m_blocked})
      p_bits->resize(index / 64 + 1);
  }
  setBit(m_sequels, index, index > 0 && m_order_list[index - 1] + 1 == s);
  ++m_in_world;
  m_newcomers.push_back(key(s));
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
  for (auto* p_bits : {&m_turns, &m_fliers, &m_walkers, &m_blocked}) setBit(*p_bits, m_cards[s].index, false);
  ++m_gaps;
  --m_in_world;
  closeGaps();
}

void WorldStore::closeGaps() {
  if (m_walks > 0 || m_gaps < 32 || m_gaps * 2 < m_order_list.size()) return;
  const std::size_t size = m_order_list.size();
  std::erase(m_order_list, kNoSlot);
  for (std::size_t i = 0; i < m_order_list.size(); ++i) {
    // Entries move towards the front only, so that what is read here has not been written yet.
    const Slot s = m_order_list[i];
    const bool blocked = isBlocked(s);
    m_cards[s].index = static_cast<std::uint32_t>(i);
    setBit(m_blocked, i, blocked);
    setBit(m_sequels, i, i > 0 && m_order_list[i - 1] + 1 == s);
    classify(s);
  }
  for (std::size_t i = m_order_list.size(); i < size; ++i) {
    for (auto* p_bits : {&m_turns, &m_fliers, &m_walkers, &m_sequels, &m_blocked}) setBit(*p_bits, i, false);
  }
  m_gaps = 0;
}

// What kind of turn the Object takes, from all that decides it.
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
  setBit(m_turns, i, turns);
  // Its next turn has to take the mark of a blocked move back.
  setBit(m_fliers, i, plain && spectral && !isBlocked(s));
  setBit(m_walkers, i, plain && !spectral && !(kLayers && m_all_swept));
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
  // Whether the new one is blocked is not known yet.
  const bool was_blocked = has(s, kInWorld) && isBlocked(s);
  if (was_blocked) setBit(m_blocked, m_cards[s].index, false);
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
  return m_cards[s].p_object->spriteMask();
}

void WorldStore::settleAnew(Slot s, FixedVector velocity, bool blocked) {
  const bool was_blocked = isBlocked(s);
  // The velocity of a blocked Object shows nowhere: gravity on something that lies still is no change.
  const bool shows = was_blocked != blocked || (!blocked && m_velocities[s] != velocity);
  m_velocities[s] = velocity;
  if (was_blocked != blocked) {
    setBit(m_blocked, m_cards[s].index, blocked);
    if (m_cards[s].solidness == SPECTRAL) classify(s);
  }
  if (shows) touch(s);
}

void WorldStore::set(Slot s, Flag flag, bool on) {
  if (has(s, flag) == on) return;
  m_cards[s].flags ^= flag;
  if (flag == kActive) file(s);
  if (flag == kPrecise) m_precise += on ? 1 : -1;
  if ((flag & (kSpecial | kBody)) != 0) classify(s);
  if ((flag & (kActive | kVisible | kNoSoft)) != 0) touch(s);
}

std::size_t WorldStore::fly(Slot first, std::size_t count, const FixedBox& boundary) {
  const Two low = load(boundary.corner);
  const Two high = load(boundary.corner + boundary.size - FixedVector{1, 1});
  FixedVector* p_positions = &m_positions[first];
  const FixedVector* p_velocities = &m_velocities[first];
  // A sign in `outside` is a coordinate that would leave the boundary.
  const auto move = [&](std::size_t i, Two& outside) {
    const Two p = load(p_positions[i]) + load(p_velocities[i]);
    outside |= (p - low) | (high - p);
    return p;
  };
  std::size_t done = 0;
  for (; done + 4 <= count; done += 4) {
    Two outside{};
    const std::array<Two, 4> moved{move(done, outside), move(done + 1, outside), move(done + 2, outside),
                                   move(done + 3, outside)};
    if ((outside[0] | outside[1]) < 0) break;
    std::memcpy(static_cast<void*>(p_positions + done), moved.data(), sizeof moved);
  }
  for (; done < count; ++done) {
    Two outside{};
    const Two moved = move(done, outside);
    if ((outside[0] | outside[1]) < 0) break;
    std::memcpy(static_cast<void*>(p_positions + done), &moved, sizeof moved);
  }
  if (m_watched) {
    for (std::size_t i = 0; i < done; ++i) note(first + static_cast<Slot>(i));
  }
  return done;
}

std::uint64_t WorldStore::walk(std::size_t word, std::uint64_t walkers, const FixedBox& boundary,
                               std::vector<ObjectKey>& met) {
  const FixedVector low = boundary.corner;
  const FixedVector high = boundary.corner + boundary.size - FixedVector{1, 1};
  const Slot* p_order = &m_order_list[word * 64];
  FixedVector* p_positions = m_positions.data();
  const FixedVector* p_velocities = m_velocities.data();
  Grid::Steps steps(m_grid);
  std::uint64_t left = walkers;
  std::uint64_t walked = 0;
  for (; left != 0; left &= left - 1) {
    const Slot s = p_order[std::countr_zero(left)];
    const FixedVector where = p_positions[s] + p_velocities[s];
    if (((where.x - low.x) | (high.x - where.x) | (where.y - low.y) | (high.y - where.y)) < 0) break;
    if (!steps.isFree(s, where)) {
      __builtin_prefetch(m_cards[s].p_object);
      list(steps.found(), met);
      break;
    }
    p_positions[s] = where;
    steps.take(s);
    ++walked;
  }
  m_blocked[word] &= ~(walkers & ~left);
  moverStats().walked += walked;
  if (m_watched) {
    for (std::uint64_t done = walkers & ~left; done != 0; done &= done - 1)
      note(p_order[std::countr_zero(done)]);
  }
  return left;
}

void WorldStore::touching(const FixedBox& box, Slot self, std::vector<ObjectKey>& out) const {
  m_candidates.clear();
  m_grid.touching(box, self, m_candidates);
  list(m_candidates, out);
}

// In creation order, each once. They are few, mostly one or two, and about to hear of it.
void WorldStore::list(std::span<const Slot> found, std::vector<ObjectKey>& out) const {
  const Card* p_cards = m_cards.data();
  if (found.size() == 1) {
    const Card& card = p_cards[found[0]];
    __builtin_prefetch(card.p_object);
    out.push_back({found[0], card.generation});
    return;
  }
  if (found.size() > kManyFound) return listMany(found, out);
  std::array<std::uint64_t, kManyFound> orders;
  std::array<Slot, kManyFound> slots;
  std::size_t count = 0;
  for (const Slot s : found) {
    const Card& card = p_cards[s];
    __builtin_prefetch(card.p_object);
    std::size_t i = count;
    for (; i > 0 && orders[i - 1] > card.order; --i) {
      orders[i] = orders[i - 1];
      slots[i] = slots[i - 1];
    }
    orders[i] = card.order;
    slots[i] = s;
    ++count;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || slots[i] != slots[i - 1]) out.push_back({slots[i], p_cards[slots[i]].generation});
  }
}

void WorldStore::listMany(std::span<const Slot> found, std::vector<ObjectKey>& out) const {
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  for (const Slot s : found) out.push_back(key(s));
  std::sort(out.begin() + begin, out.end(),
            [this](ObjectKey a, ObjectKey b) { return m_cards[a.slot].order < m_cards[b.slot].order; });
  out.erase(std::unique(out.begin() + begin, out.end()), out.end());
}

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

void WorldStore::note(Slot s) {
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
  // An inactive Object stands, whatever its velocity.
  if (has(s, kActive) && !isBlocked(s)) {
    f.velocity = m_velocities[s];
    if (isVelocity(f.velocity + m_accelerations[s])) f.acceleration = m_accelerations[s];
    // A body's velocity is that of this moment; what it adds in a tick is half a tick's acceleration more.
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
