#include "client/world/ExtrapolationClamp.h"

#include <algorithm>

#include "client/world/ReplicaBarriers.h"
#include "shared/replica/Acks.h"

namespace naiad {

namespace {

constexpr std::int64_t kCellWidth = 4;  // in characters
constexpr std::int64_t kCellHeight = 2;
constexpr std::int64_t kMaxCells = 64;

// Work, in units of computing or comparing one box.
constexpr std::size_t kCellWork = 2;    // sorting an object into a cell
constexpr std::size_t kLookupWork = 4;  // finding a cell
constexpr std::size_t kMaxIndexWork = ExtrapolationClamp::kMaxWork / 2;

std::uint64_t cellKey(std::int64_t x, std::int64_t y) {
  return static_cast<std::uint64_t>(x) << 32 | static_cast<std::uint32_t>(y);
}

}  // namespace

ExtrapolationClamp::Range ExtrapolationClamp::cellsOf(const df::FixedBox& box) {
  const auto down = [](df::Fixed v, std::int64_t cells) {
    const std::int64_t whole = v >> df::kFixedBits;
    return whole / cells - (whole % cells < 0 ? 1 : 0);
  };
  return {down(box.corner.x, kCellWidth), down(box.corner.y, kCellHeight),
          down(box.corner.x + box.size.x, kCellWidth), down(box.corner.y + box.size.y, kCellHeight)};
}

ExtrapolationClamp::ExtrapolationClamp(const Replica& replica, std::uint32_t known, std::uint32_t drawn)
    : m_known(known), m_drawn(drawn) {
  if (!isNewer(drawn, known) || drawn - known > kMaxTicks) return;
  m_ticks = drawn - known;
  for (const auto& [slot, entry] : replica.entries()) {
    if (!entry.alive || entry.state.body.solidness != df::HARD) continue;
    if (!addSolid(entry.state)) break;
  }
  std::sort(m_cells.begin(), m_cells.end());
  clampAll();
}

/// Returns false if the work limit of the index is reached.
bool ExtrapolationClamp::addSolid(const ObjectState& object) {
  const bool moves = isMoving(object.motion);
  const std::uint32_t last = moves ? m_drawn : m_known;
  m_work += moves ? 2 * m_ticks : 1;
  m_exhausted = m_work > kMaxIndexWork;
  if (m_exhausted) return false;
  const auto along = boxAlong(object, m_known, last);
  if (!along) return true;
  m_solids.push_back({&object, *along, cellsOf(*along), m_boxes.size(), moves});
  // boxAlong() has checked that there is a box in all these ticks.
  for (std::uint32_t tick = m_known; tick != last + 1; ++tick) {
    m_boxes.push_back(df::translate(object.body.box, positionAt(object.motion, tick)));
  }
  addToIndex(m_solids.back(), static_cast<std::uint32_t>(m_solids.size() - 1));
  return true;
}

void ExtrapolationClamp::addToIndex(const Solid& solid, std::uint32_t index) {
  if (solid.range.count() > kMaxCells) {
    m_large.push_back(index);
    return;
  }
  m_work += kCellWork * static_cast<std::size_t>(solid.range.count());
  for (std::int64_t y = solid.range.top; y <= solid.range.bottom; ++y) {
    for (std::int64_t x = solid.range.left; x <= solid.range.right; ++x)
      m_cells.emplace_back(cellKey(x, y), index);
  }
}

void ExtrapolationClamp::clampAll() {
  const auto movers = static_cast<std::size_t>(
      std::count_if(m_solids.begin(), m_solids.end(), [](const Solid& solid) { return solid.moves; }));
  if (movers == 0) return;
  const std::size_t share = (kMaxWork - std::min(m_work, kMaxWork)) / movers;
  std::size_t allowed = m_work;  // each mover may also use the work that earlier movers left
  for (const Solid& mover : m_solids) {
    if (!mover.moves) continue;
    allowed += share;
    std::uint32_t first = m_ticks + 1;  // the first tick in which the mover would be blocked
    forEachNear(mover, allowed, [&](const Solid& other) {
      if (other.p_state->order == mover.p_state->order || !df::intersects(mover.along, other.along)) return;
      first = firstTouch(mover, other, first);
    });
    if (first > m_ticks) continue;
    m_clamped[mover.p_state] = positionAt(mover.p_state->motion, m_known + first - 1);
  }
}

/// Calls `visit` once for each solid that may touch the mover, until the work exceeds `allowed`.
template <class Visit>
void ExtrapolationClamp::forEachNear(const Solid& mover, std::size_t allowed, Visit visit) {
  const auto add = [this, allowed](std::size_t work) {
    m_work += work;
    m_exhausted = m_exhausted || m_work > allowed;
    return m_work <= allowed;
  };
  const Range& range = mover.range;
  if (range.count() > kMaxCells) {
    for (const Solid& solid : m_solids) {
      if (!add(1)) return;
      visit(solid);
    }
    return;
  }
  for (const std::uint32_t index : m_large) {
    if (!add(1)) return;
    visit(m_solids[index]);
  }
  for (std::int64_t y = range.top; y <= range.bottom; ++y) {
    for (std::int64_t x = range.left; x <= range.right; ++x) {
      if (!add(kLookupWork)) return;
      const Cell key = cellKey(x, y);
      auto at = std::lower_bound(m_cells.begin(), m_cells.end(), std::pair<Cell, std::uint32_t>(key, 0));
      for (; at != m_cells.end() && at->first == key; ++at) {
        if (!add(1)) return;
        const Solid& solid = m_solids[at->second];
        // Visit only in the first cell that both share.
        if (x == std::max(range.left, solid.range.left) && y == std::max(range.top, solid.range.top))
          visit(solid);
      }
    }
  }
}

/// Returns the first tick, counted from m_known, in which the mover would touch the other at the mover's
/// turn. Returns `before` if there is no such tick before it, or if they already touch in m_known.
std::uint32_t ExtrapolationClamp::firstTouch(const Solid& mover, const Solid& other, std::uint32_t before) {
  ++m_work;
  if (df::intersects(boxOf(mover, 0), boxOf(other, 0))) return before;
  // At the mover's turn, objects created later have not moved yet.
  const std::uint32_t late = other.p_state->order < mover.p_state->order ? 0 : 1;
  for (std::uint32_t i = 1; i < before; ++i) {
    ++m_work;
    if (df::intersects(boxOf(mover, i), boxOf(other, i - late))) return i;
  }
  return before;
}

df::FixedVector ExtrapolationClamp::positionOf(const ObjectState& object) const {
  if (!m_clamped.empty()) {
    const auto held = m_clamped.find(&object);
    if (held != m_clamped.end()) return held->second;
  }
  return positionAt(object.motion, m_drawn);
}

df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn) {
  return ExtrapolationClamp(replica, known, drawn).positionOf(object);
}

}  // namespace naiad
