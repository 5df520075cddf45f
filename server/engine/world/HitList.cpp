#include "engine/world/HitList.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/collision/SweepPath.h"
#include "engine/world/CollisionRule.h"
#include "shared/values/Fixed.h"

namespace df {

namespace {

/// Quick bounds on when a move touches a box, in doubles and without a branch. They are a little too wide on
/// both sides, so that no hit is missed; Sweep then tests exactly.
class SweepBounds {
 public:
  /// Times of the move at which a box is touched, also before its start and after its end. If the box is
  /// never touched, enter > leave.
  struct Stay {
    double enter;
    double leave;
  };

  explicit SweepBounds(const SweepPath& path)
      : m_x(path.box().corner.x + path.from().x, path.box().size.x, path.lengthX(),
            path.to().x < path.from().x),
        m_y(path.box().corner.y + path.from().y, path.box().size.y, path.lengthY(),
            path.to().y < path.from().y) {}

  Stay at(const FixedBox& other) const {
    const Stay x = m_x.at(other.corner.x, other.size.x);
    const Stay y = m_y.at(other.corner.y, other.size.y);
    return {std::max(x.enter, y.enter), std::min(x.leave, y.leave)};
  }
  /// Returns an upper bound of `enter` of all boxes that are hit at or before `moment`.
  static double latest(Moment moment) { return moment.toDouble() * (1 + 1e-12); }

 private:
  // Margin on either side, in units: coordinates in doubles have errors of some thousand units.
  static constexpr double kSlack = 1 << 16;
  // Time per unit on an axis without movement: practically infinite.
  static constexpr double kForEver = 1e100;

  struct Axis {
    double centre;
    double half;      // half of the size, plus kSlack
    double per_unit;  // time per unit; negative if the move goes backward

    Axis(Fixed corner, Fixed size, std::uint64_t length, bool back)
        : centre(static_cast<double>(corner) + 0.5 * static_cast<double>(size)),
          half(0.5 * static_cast<double>(size) + kSlack),
          per_unit(length == 0 ? kForEver : (back ? -1 : 1) / static_cast<double>(length)) {}
    Stay at(Fixed corner, Fixed size) const {
      const double other_half = 0.5 * static_cast<double>(size);
      const double middle = (static_cast<double>(corner) + other_half - centre) * per_unit;
      const double length = (half + other_half) * std::abs(per_unit);
      return {middle - length, middle + length};
    }
  };

  Axis m_x;
  Axis m_y;
};

/// A path cut into pieces, so that Objects along it are searched in the order of travel.
///
/// The path has as many steps as its longer axis has units. The position on the shorter axis after a step is
/// rounded, so pieces are a little too wide. Only the sweep decides what is hit, and when.
class SweepSegments {
 public:
  /// The length of the path must not be 0.
  explicit SweepSegments(const SweepPath& path)
      : m_horizontal(path.lengthX() >= path.lengthY()),
        m_along(axis(path, m_horizontal)),
        m_across(axis(path, !m_horizontal)),
        m_slope(halfOf(m_across.length) / std::max(halfOf(m_along.length), 1.0)) {}

  /// True if the longer axis is x.
  bool isHorizontal() const { return m_horizontal; }
  std::uint64_t length() const { return m_along.length; }
  /// Returns the units that the move covers on the shorter axis in each step.
  double slope() const { return m_slope; }
  /// Returns the time at which this many steps are done.
  Moment at(std::uint64_t steps) const { return {steps, m_along.length}; }
  /// Returns a lower bound (relative error 1e-12) of the steps done at `moment`.
  std::uint64_t stepsBefore(Moment moment) const {
    if (moment.numerator == 0) return 0;
    constexpr double kLess = 1 - 1e-12;
    return static_cast<std::uint64_t>(moment.toDouble() * kLess * static_cast<double>(m_along.length));
  }
  /// Returns the piece from step `begin` to step `end`.
  SweepPath::Piece piece(std::uint64_t begin, std::uint64_t end) const {
    const auto [along_low, along_high] = std::minmax({m_along.after(begin), m_along.after(end)});
    const auto [across_low, across_high] =
        std::minmax({m_across.after(across(begin, -kSlack)), m_across.after(across(end, kSlack))});
    if (m_horizontal) return {{along_low, across_low}, {along_high, across_high}};
    return {{across_low, along_low}, {across_high, along_high}};
  }

 private:
  // Margin of across(), in units of two steps. Rounding 64-bit steps to the 53 bits of a double makes errors
  // of some thousand units, far less than this.
  static constexpr double kSlack = 1 << 20;

  struct Axis {
    Fixed start;  // the box's corner
    std::uint64_t length;
    std::uint64_t back;  // all ones if the move goes backward: avoids an unpredictable branch

    Fixed after(std::uint64_t steps) const {
      return static_cast<Fixed>(static_cast<std::uint64_t>(start) + ((steps ^ back) - back));
    }
  };

  static Axis axis(const SweepPath& path, bool is_x) {
    const FixedVector corner = path.box().corner + path.from();
    if (is_x) return {corner.x, path.lengthX(), path.to().x < path.from().x ? ~std::uint64_t{0} : 0};
    return {corner.y, path.lengthY(), path.to().y < path.from().y ? ~std::uint64_t{0} : 0};
  }
  // Signed numbers are converted to doubles faster than unsigned ones.
  static double halfOf(std::uint64_t steps) {
    return static_cast<double>(static_cast<std::int64_t>(steps >> 1));
  }
  // Returns the steps done on the shorter axis after `steps` on the longer one, plus 2 * slack, clamped to 0
  // and the length of the shorter axis.
  std::uint64_t across(std::uint64_t steps, double slack) const {
    const double half = m_slope * halfOf(steps) + slack;
    if (half <= 0) return 0;
    if (half >= halfOf(m_across.length)) return m_across.length;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(half)) * 2;
  }

  bool m_horizontal;
  Axis m_along;   // the longer axis
  Axis m_across;  // the shorter axis
  double m_slope;
};

// Among many Objects a hit is near; among few, an empty piece costs little. So the first piece is short, and
// each piece after an empty one is twice as long. Unit: the largest box of the level of the grid.
constexpr Fixed kFirstPiece = 4;  // in level 0; 1 in all other levels
constexpr Fixed kMaxPiece = 16;
constexpr Fixed kMaxFlatPiece = 64;  // for a path that hardly changes its row
constexpr double kFlat = 0.25;       // slope below which a path counts as such

// Up to this many pieces cost less than testing all Objects, even if there are very few Objects.
constexpr int kFewPieces = 32;

// Progress of the search in one level of the grid, and the length of the pieces there.
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
         Moment since, const ObjectKeySet* p_met)
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

  // Searches the levels piece by piece, always the level that is furthest behind.
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
      // All levels are searched up to `from`, so all further Objects are hit after the end of the list.
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
    // Pieces overlap by the mover's size, so pieces shorter than that would only repeat tests.
    const Fixed least = horizontal ? m_path.box().size.x : m_path.box().size.y;
    const bool flat = horizontal && pieces.slope() < kFlat;
    const Fixed longest = (flat ? kMaxFlatPiece : kMaxPiece) * cell;
    return {begin, static_cast<std::uint64_t>(std::max(first, least)), static_cast<std::uint64_t>(longest),
            level};
  }

  // A piece costs about as much as testing a few Objects, so the number of Objects limits that of pieces.
  bool isWorthMore(int number) const {
    return number < kFewPieces || number < kFewPieces + m_store.grid().size() / 4;
  }

  // Returns true if there was any candidate.
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

  // Tests the collected candidates, the nearest first, until the next lies beyond the end of the list.
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
      left += ((stay.enter <= stay.leave) & (stay.enter <= until) & (stay.leave >= 0)) ? 1 : 0;
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
    const std::optional<Moment> moment = pair.firstCollision(m_path.sweep(), boxOf(other, level));
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
  const ObjectKeySet* const m_p_met;
  std::optional<SweepBounds> m_bounds;  // made when there are several candidates
  std::size_t m_count = 0;
  std::array<Slot, kBatch> m_near;
};

void HitList::fill(const WorldStore& store, WorldStore::Slot mover, const SweepPath& path, End end,
                   Moment since, const ObjectKeySet* p_met) {
  m_hits.clear();
  m_end.reset();
  Search(*this, store, mover, path, end, since, p_met).run();
  if (m_hits.size() < 2) return;
  std::sort(m_hits.begin(), m_hits.end(), [](const Hit& a, const Hit& b) {
    const auto earlier = a.moment <=> b.moment;
    return std::is_eq(earlier) ? a.order < b.order : std::is_lt(earlier);
  });
  // Removes hits that were found twice, and hits beyond the end, found before the end was known.
  const auto rest = std::unique(m_hits.begin(), m_hits.end(),
                                [](const Hit& a, const Hit& b) { return a.order == b.order; });
  m_hits.erase(rest, m_hits.end());
  while (m_end && m_hits.back().moment > *m_end) m_hits.pop_back();
}

}  // namespace df
