#include "HitList.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "Pair.h"

namespace df {

namespace {

// How far the way has been searched in one level of the grid, and in pieces of which length.
struct Front {
  std::uint64_t reached;
  std::uint64_t stride;
  std::uint64_t longest;
  int level;
};

// A hit is near where many are, and where few are an empty piece costs little. So the first piece is short,
// and whenever nobody was there, the next one is longer: in cells of the level.
constexpr Fixed kFirstPiece = 4;
constexpr Fixed kLongestPiece = 16;
constexpr Fixed kLongestFlatPiece = 64;  // of a way that hardly changes its row
constexpr double kFlat = 0.25;

// So many pieces are cheaper than to look at everything, even where there is next to nothing.
constexpr int kFewPieces = 32;

}  // namespace

struct HitList::Search {
  const WorldStore& store;
  const WorldStore::Slot mover;
  const Way& way;
  const End end;
  const Moment since;
  const KeySet* const p_met;
  HitList& list;
  int seen = 0;

  Front frontOf(int level, std::uint64_t begin) const {
    const FixedVector cell = Grid::largest(level);
    const bool flat = way.isHorizontal() && way.slope() < kFlat;
    const Fixed length = way.isHorizontal() ? cell.x : cell.y;
    const Fixed first = level == 0 ? kFirstPiece * length : length;
    // Neighbouring pieces both see what is within the mover's size: not to look at that many times.
    const Fixed least = way.isHorizontal() ? way.boxSize().x : way.boxSize().y;
    return {begin, static_cast<std::uint64_t>(std::max(first, least)),
            static_cast<std::uint64_t>((flat ? kLongestFlatPiece : kLongestPiece) * length), level};
  }

  void lookAt(WorldStore::Slot other, const FixedBox& box) {
    if (other == mover) return;
    ++seen;
    const Pair pair(store, mover, other);
    const std::optional<Moment> moment =
        pair.firstMeeting(way.sweep(), translate(box, store.position(other)));
    if (!moment || (list.m_end && *moment > *list.m_end)) return;
    if (since.numerator != 0 && *moment < since) return;
    if (p_met != nullptr && p_met->contains(store.key(other))) return;
    if (end == kFirst || pair.blocks(way.from(), way.to())) list.m_end = moment;
    list.m_hits.push_back({*moment, store.order(other), store.key(other)});
  }

  void searchPiece(int level, std::uint64_t from, std::uint64_t to) {
    const Way::Piece piece = way.piece(from, to);
    const FixedVector low = piece.low - Grid::largest(level);
    const FixedVector high = piece.high + way.boxSize();
    const Grid& grid = store.grid();
    if (level == 0) {
      grid.visitCorners(0, low, high, [this](WorldStore::Slot other) { lookAt(other, kCharacterBox); });
    } else {
      grid.visitCorners(level, low, high,
                        [this](WorldStore::Slot other) { lookAt(other, store.box(other)); });
    }
  }

  // A piece costs about as much as to look at a few Objects: no more of them than everybody is worth.
  bool isWorthMore(int pieces) const {
    return pieces < kFewPieces || pieces < kFewPieces + store.grid().size() / 4;
  }

  void run() {
    const std::uint64_t length = way.length();
    const std::uint64_t begin = length == 0 ? 0 : way.stepsBefore(since);
    std::array<Front, Grid::kLevels> fronts;
    std::size_t count = 0;
    for (std::uint32_t left = store.grid().levels(); left != 0; left &= left - 1) {
      fronts[count++] = frontOf(std::countr_zero(left), begin);
    }
    for (int pieces = 0; count > 0; ++pieces) {
      Front& front = fronts[0];  // the one that is behind
      for (std::size_t i = 1; i < count; ++i) {
        if (fronts[i].reached < front.reached) std::swap(front, fronts[i]);
      }
      const std::uint64_t from = front.reached;
      // Whoever is ahead of all fronts is hit later.
      if (list.m_end && from != begin && *list.m_end <= way.at(from)) return;
      const bool is_last = length - from <= front.stride || !isWorthMore(pieces);
      front.reached = is_last ? length : from + front.stride;
      seen = 0;
      searchPiece(front.level, from, front.reached);
      if (seen == 0 && front.stride < front.longest) front.stride *= 2;
      if (is_last) front = fronts[--count];
    }
  }
};

void HitList::fill(const WorldStore& store, WorldStore::Slot mover, const Way& way, End end, Moment since,
                   const KeySet* p_met) {
  m_hits.clear();
  m_end.reset();
  Search{store, mover, way, end, since, p_met, *this}.run();
  if (m_hits.size() < 2) return;
  std::sort(m_hits.begin(), m_hits.end(), [](const Hit& a, const Hit& b) {
    const auto earlier = a.moment <=> b.moment;
    return earlier != 0 ? earlier < 0 : a.order < b.order;
  });
  // Some were found twice, some before it was known where the list ends.
  const auto rest = std::unique(m_hits.begin(), m_hits.end(),
                                [](const Hit& a, const Hit& b) { return a.order == b.order; });
  m_hits.erase(rest, m_hits.end());
  while (m_end && m_hits.back().moment > *m_end) m_hits.pop_back();
}

}  // namespace df
