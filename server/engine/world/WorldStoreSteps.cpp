// The part of WorldStore that moves many Objects at a time and lists the Objects that a box touches.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "engine/collision/GridSteps.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

constexpr std::size_t kMaxSmallList = 12;  // longer lists are sorted by std::sort()

// Both coordinates in one vector register, if the processor has any (an extension of GCC and Clang).
using Two = Fixed __attribute__((vector_size(16)));

Two load(FixedVector v) {
  return Two{v.x, v.y};
}

}  // namespace

std::size_t WorldStore::fly(Slot first, std::size_t count, const FixedBox& boundary) {
  const Two low = load(boundary.corner);
  const Two high = load(boundary.corner + boundary.size - FixedVector{1, 1});
  FixedVector* p_positions = &m_positions[first];
  const FixedVector* p_velocities = &m_velocities[first];
  // A negative number in `outside` means that an Object would leave the boundary.
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
    for (std::size_t i = 0; i < done; ++i) flagChanged(first + static_cast<Slot>(i));
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
  Grid::Steps steps(m_grid, crowdThreshold());
  std::uint64_t left = walkers;
  std::uint64_t walked = 0;
  std::uint64_t stopped = 0;
  for (; left != 0; left &= left - 1) {
    const Slot s = p_order[std::countr_zero(left)];
    const FixedVector where = p_positions[s] + p_velocities[s];
    if (((where.x - low.x) | (high.x - where.x) | (where.y - low.y) | (high.y - where.y)) < 0) break;
    if (!steps.isFree(s, where)) {
      __builtin_prefetch(m_cards[s].p_object);
      if (steps.found().size() <= crowdThreshold()) {
        list(steps.found(), met);
        break;
      }
      const FixedBox target = worldBox(s, where);
      const std::optional<bool> moves = moveWithoutHandlers(s, target, steps.found());
      if (!moves) {
        touching(target, s, met);
        break;
      }
      ++moverStats().unheard;
      if (!*moves) {
        stopped |= left & -left;
        continue;
      }
    }
    p_positions[s] = where;
    steps.fileAtTarget(s);
    ++walked;
  }
  const std::uint64_t still = stopped & m_bits.blocked[word];
  m_bits.blocked[word] = (m_bits.blocked[word] & ~(walkers & ~left)) | stopped;
  moverStats().walked += walked;
  if (m_watched) {
    for (std::uint64_t done = walkers & ~left & ~still; done != 0; done &= done - 1)
      flagChanged(p_order[std::countr_zero(done)]);
  }
  return left;
}

// Returns the number of touched Objects above which it pays to test first whether any of them has a handler.
std::size_t WorldStore::crowdThreshold() const {
  constexpr int kHandlersPerOther = 16;  // Objects that can be tested in the time of listing one
  return static_cast<std::size_t>(std::max(32, m_handlers / kHandlersPerOther));
}

// True if an Object of this set, except `self`, touches the box.
bool WorldStore::isAnyAt(const UpdateMasks::Words& row, const FixedBox& box, Slot self) const {
  for (std::size_t word = 0; word < row.size(); ++word) {
    for (std::uint64_t left = row[word]; left != 0; left &= left - 1) {
      const Slot t = m_order_list[word * 64 + static_cast<std::size_t>(std::countr_zero(left))];
      if (t != self && intersects(worldBox(t, m_positions[t]), box)) return true;
    }
  }
  return false;
}

// True if an Object at `target` blocks the mover. `some` are Objects that are known to be there. Tests either
// all Objects that are there or all in the world that could block, whichever are fewer.
bool WorldStore::isBlockedAt(const FixedBox& target, Slot mover, std::span<const Slot> some) const {
  const bool hard = m_cards[mover].solidness == HARD;
  const bool no_soft = has(mover, kNoSoft);
  const auto blocks = [&](Slot t) {
    const Solidness its = m_cards[t].solidness;
    return (hard && its == HARD) || (no_soft && its == SOFT);
  };
  if (std::any_of(some.begin(), some.end(), blocks)) return true;
  if (!hard && !no_soft) return false;
  const int blockers = (hard ? m_hards : 0) + (no_soft ? m_softs : 0);
  const auto most = static_cast<std::size_t>(blockers);
  m_candidates.clear();  // `some` may be in m_candidates; it is not read again
  m_grid.touching(target, mover, m_candidates, most);
  if (std::any_of(m_candidates.begin(), m_candidates.end(), blocks)) return true;
  if (m_candidates.size() <= most) return false;  // these are all Objects at the target
  return (hard && isAnyAt(m_bits.hards, target, mover)) || (no_soft && isAnyAt(m_bits.softs, target, mover));
}

// Returns whether a move happens, given some of the Objects that it touches. Returns nullopt if the mover or
// any Object that it touches has a handler, if any Object is precise, or if the mover may move out of others.
// Without handlers nothing changes during the move, so one Object that blocks decides.
std::optional<bool> WorldStore::moveWithoutHandlers(Slot mover, const FixedBox& target,
                                                    std::span<const Slot> some) const {
  if (handlesEvents(mover) || hasPrecise() || mayMoveOut(mover)) return std::nullopt;
  if (m_handlers > 0 && isAnyAt(m_bits.handlers, target, mover)) return std::nullopt;
  return !isBlockedAt(target, mover, some);
}

std::optional<bool> WorldStore::touchingTarget(Slot mover, const FixedBox& target,
                                               std::vector<ObjectKey>& out) const {
  m_candidates.clear();
  const std::size_t most = handlesEvents(mover) ? Grid::kAll : crowdThreshold();
  m_grid.touching(target, mover, m_candidates, most);
  if (m_candidates.size() > most) {
    if (const std::optional<bool> moves = moveWithoutHandlers(mover, target, m_candidates)) return moves;
    m_candidates.clear();
    m_grid.touching(target, mover, m_candidates);
  }
  list(m_candidates, out);
  return std::nullopt;
}

void WorldStore::touching(const FixedBox& box, Slot self, std::vector<ObjectKey>& out) const {
  m_candidates.clear();
  m_grid.touching(box, self, m_candidates);
  list(m_candidates, out);
}

// Lists the slots in creation order, each once. There are few, mostly one or two, whose handlers run next.
void WorldStore::list(std::span<const Slot> found, std::vector<ObjectKey>& out) const {
  const Card* p_cards = m_cards.data();
  if (found.size() == 1) {
    const Card& card = p_cards[found[0]];
    __builtin_prefetch(card.p_object);
    out.push_back({found[0], card.generation});
    return;
  }
  if (found.size() > kMaxSmallList) return listMany(found, out);
  std::array<std::uint64_t, kMaxSmallList> orders;
  std::array<Slot, kMaxSmallList> slots;
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

}  // namespace df
