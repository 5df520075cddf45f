#include "engine/world/HitList.h"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <utility>

#include "engine/collision/SweepBounds.h"
#include "engine/collision/SweepSegments.h"
#include "engine/world/CollisionRule.h"

namespace df {

namespace {

// Among many Objects a hit is near, and among few an empty piece costs little. So the first piece is short,
// and after each empty piece the next one is longer: in cells of the level.
constexpr Fixed kFirstPiece = 4;
constexpr Fixed kLongestPiece = 16;
constexpr Fixed kLongestFlatPiece = 64;  // of a path that hardly changes its row
constexpr double kFlat = 0.25;

// Up to so many pieces are cheaper than to test all Objects, even where there are very few.
constexpr int kFewPieces = 32;

// How far the path has been searched in one level of the grid, and in pieces of which length.
struct Front {
  std::uint64_t reached;
  std::uint64_t stride;
  std::uint64_t longest;
  int level;
};

}  // namespace

class HitList::Search {
 public:
  Search(HitList& list, const WorldStore& store, WorldStore::Slot mover, const SweepPath& path, End end,
         Moment since, const KeySet* p_met)
      : m_list(list),
        m_store(store),
        m_mover(mover),
        m_path(path),
        m_end(end),
        m_since(since),
        m_p_met(p_met) {}

  void run() {
    constexpr std::uint64_t kShort = kFirstPiece * kFixedOne;
    if (m_path.lengthX() > kShort || m_path.lengthY() > kShort) return runAlong(SweepSegments(m_path));
    const SweepPath::Piece whole = m_path.whole();
    for (std::uint32_t left = m_store.grid().levels(); left != 0; left &= left - 1) {
      searchPiece(std::countr_zero(left), whole);
    }
  }

 private:
  using Slot = WorldStore::Slot;
  static constexpr std::size_t kBatch = 64;

  struct Candidate {
    double enter;
    Slot slot;
  };

  // Level by level, always the one that is behind.
  void runAlong(const SweepSegments& pieces) {
    const std::uint64_t begin = pieces.stepsBefore(m_since);
    std::array<Front, Grid::kLevels> fronts;
    std::size_t count = 0;
    for (std::uint32_t left = m_store.grid().levels(); left != 0; left &= left - 1) {
      fronts[count++] = frontOf(std::countr_zero(left), pieces, begin);
    }
    for (int number = 0; count > 0; ++number) {
      Front& front = fronts[0];
      for (std::size_t i = 1; i < count; ++i) {
        if (fronts[i].reached < front.reached) std::swap(front, fronts[i]);
      }
      const std::uint64_t from = front.reached;
      // What lies ahead of all fronts is hit later.
      if (m_list.m_end && from != begin && *m_list.m_end <= pieces.at(from)) return;
      const bool is_last = pieces.length() - from <= front.stride || !isWorthMore(number);
      front.reached = is_last ? pieces.length() : from + front.stride;
      const bool is_empty = !searchPiece(front.level, pieces.piece(from, front.reached));
      if (is_empty && front.stride < front.longest) front.stride *= 2;
      if (is_last) front = fronts[--count];
    }
  }

  Front frontOf(int level, const SweepSegments& pieces, std::uint64_t begin) const {
    const bool horizontal = pieces.isHorizontal();
    const Fixed cell = horizontal ? Grid::largest(level).x : Grid::largest(level).y;
    const Fixed first = level == 0 ? kFirstPiece * cell : cell;
    // Neighbouring pieces both see what is within the mover's size: not to look at that many times.
    const Fixed least = horizontal ? m_path.box().size.x : m_path.box().size.y;
    const bool flat = horizontal && pieces.slope() < kFlat;
    const Fixed longest = (flat ? kLongestFlatPiece : kLongestPiece) * cell;
    return {begin, static_cast<std::uint64_t>(std::max(first, least)), static_cast<std::uint64_t>(longest),
            level};
  }

  // A piece costs about as much as to test a few Objects: no more pieces than to test all Objects is worth.
  bool isWorthMore(int number) const {
    return number < kFewPieces || number < kFewPieces + m_store.grid().size() / 4;
  }

  // Return whether any candidate was near.
  bool searchPiece(int level, const SweepPath::Piece& piece) {
    bool is_empty = true;
    const FixedVector low = piece.low - Grid::largest(level);
    const FixedVector high = piece.high + m_path.box().size;
    m_store.grid().visitCorners(level, low, high, [&](Slot other) {
      m_store.prefetch(other);
      m_near[m_count] = other;
      m_count += other != m_mover ? 1 : 0;
      if (m_count < kBatch) return;
      is_empty = false;
      lookAtNear(level);
    });
    if (m_count == 0) return !is_empty;
    lookAtNear(level);
    return true;
  }

  // Test the collected candidates, the nearest first, until the rest is beyond the end of the list.
  void lookAtNear(int level) {
    std::size_t count = std::exchange(m_count, 0);
    if (count == 1) return lookAt(m_near[0], level);
    if (!m_bounds) m_bounds.emplace(m_path);
    const double until = m_list.m_end ? SweepBounds::latest(*m_list.m_end) : 1;
    std::array<Candidate, kBatch> candidates;
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const SweepBounds::Stay stay = m_bounds->at(boxOf(m_near[i], level));
      candidates[left] = {stay.enter, m_near[i]};
      left += (stay.enter <= stay.leave) & (stay.enter <= until) & (stay.leave >= 0) ? 1 : 0;
    }
    for (; left > 0; --left) {
      Candidate* p_next = candidates.data();
      for (std::size_t i = 1; i < left; ++i) {
        if (candidates[i].enter < p_next->enter) p_next = &candidates[i];
      }
      if (m_list.m_end && p_next->enter > SweepBounds::latest(*m_list.m_end)) return;
      lookAt(p_next->slot, level);
      *p_next = candidates[left - 1];
    }
  }

  void lookAt(Slot other, int level) {
    const CollisionRule pair(m_store, m_mover, other);
    const std::optional<Moment> moment = pair.firstMeeting(m_path.sweep(), boxOf(other, level));
    if (!moment || (m_list.m_end && *moment > *m_list.m_end)) return;
    if (m_since.numerator != 0 && *moment < m_since) return;
    if (m_p_met != nullptr && m_p_met->contains(m_store.key(other))) return;
    if (m_end == kFirst || pair.blocks(m_path.from(), m_path.to())) m_list.m_end = moment;
    m_list.m_hits.push_back({*moment, m_store.order(other), m_store.key(other)});
  }

  FixedBox boxOf(Slot slot, int level) const {
    return translate(level == 0 ? kCharacterBox : m_store.box(slot), m_store.position(slot));
  }

  HitList& m_list;
  const WorldStore& m_store;
  const Slot m_mover;
  const SweepPath& m_path;
  const End m_end;
  const Moment m_since;
  const KeySet* const m_p_met;
  std::optional<SweepBounds> m_bounds;  // made when there are several to look at
  std::size_t m_count = 0;
  std::array<Slot, kBatch> m_near;
};

void HitList::fill(const WorldStore& store, WorldStore::Slot mover, const SweepPath& path, End end,
                   Moment since, const KeySet* p_met) {
  m_hits.clear();
  m_end.reset();
  Search(*this, store, mover, path, end, since, p_met).run();
  if (m_hits.size() < 2) return;
  std::sort(m_hits.begin(), m_hits.end(), [](const Hit& a, const Hit& b) {
    const auto earlier = a.moment <=> b.moment;
    return std::is_eq(earlier) ? a.order < b.order : std::is_lt(earlier);
  });
  // Some were found twice, some before it was known where the list ends.
  const auto rest = std::unique(m_hits.begin(), m_hits.end(),
                                [](const Hit& a, const Hit& b) { return a.order == b.order; });
  m_hits.erase(rest, m_hits.end());
  while (m_end && m_hits.back().moment > *m_end) m_hits.pop_back();
}

}  // namespace df
