#include "client/world/ExtrapolationClamp.h"

#include <algorithm>

#include "client/world/Surroundings.h"
#include "shared/replica/Acks.h"

namespace naiad {

namespace {

constexpr std::int64_t kCellWidth = 4;  // in characters
constexpr std::int64_t kCellHeight = 2;
constexpr std::int64_t kMaxCells = 64;

std::uint64_t cellKey(std::int64_t x, std::int64_t y) {
  return static_cast<std::uint64_t>(x) << 32 | static_cast<std::uint32_t>(y);
}

/// The boxes of an object from the tick `first` on, which boxAlong() found to be somewhere.
void appendPlaces(std::vector<df::FixedBox>& out, const ObjectState& object, std::uint32_t first,
                  std::uint32_t ticks) {
  for (std::uint32_t i = 0; i <= ticks; ++i) {
    out.push_back(df::translate(object.body.box, positionAt(object.motion, first + i)));
  }
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
    const auto along = boxAlong(entry.state, known, drawn);
    if (!along) continue;
    m_solids.push_back({entry.state.order, *along, cellsOf(*along), m_places.size()});
    appendPlaces(m_places, entry.state, known, m_ticks);
  }
  for (std::uint32_t i = 0; i < m_solids.size(); ++i) sort(m_solids[i], i);
  std::sort(m_cells.begin(), m_cells.end());
}

void ExtrapolationClamp::sort(const Solid& solid, std::uint32_t index) {
  if (solid.range.count() > kMaxCells) {
    m_large.push_back(index);
    return;
  }
  for (std::int64_t y = solid.range.top; y <= solid.range.bottom; ++y) {
    for (std::int64_t x = solid.range.left; x <= solid.range.right; ++x)
      m_cells.emplace_back(cellKey(x, y), index);
  }
}

/// Calls `visit` once for each solid that may touch the box.
template <class Visit>
void ExtrapolationClamp::forEachNear(const df::FixedBox& box, Visit visit) const {
  const Range range = cellsOf(box);
  if (range.count() > kMaxCells) {
    for (const Solid& solid : m_solids) visit(solid);
    return;
  }
  for (const std::uint32_t index : m_large) visit(m_solids[index]);
  for (std::int64_t y = range.top; y <= range.bottom; ++y) {
    for (std::int64_t x = range.left; x <= range.right; ++x) {
      const Cell key = cellKey(x, y);
      auto at = std::lower_bound(m_cells.begin(), m_cells.end(), std::pair<Cell, std::uint32_t>(key, 0));
      for (; at != m_cells.end() && at->first == key; ++at) {
        const Solid& solid = m_solids[at->second];
        // Of the cells that the two share, the first one counts.
        if (x == std::max(range.left, solid.range.left) && y == std::max(range.top, solid.range.top))
          visit(solid);
      }
    }
  }
}

/// The first tick after known, counted from there, in which the mover would touch the other, as that is at
/// the mover's turn; `before` if there is none before that, or if they touch already.
std::uint32_t ExtrapolationClamp::firstTouch(const std::vector<df::FixedBox>& mover, std::uint64_t order,
                                             const Solid& other, std::uint32_t before) const {
  const df::FixedBox* p_other = &m_places[other.places];
  if (df::intersects(mover[0], p_other[0])) return before;
  const std::uint32_t late = other.order < order ? 0 : 1;  // those created later have not moved yet
  for (std::uint32_t i = 1; i < before; ++i) {
    if (df::intersects(mover[i], p_other[i - late])) return i;
  }
  return before;
}

df::FixedVector ExtrapolationClamp::positionOf(const ObjectState& object) const {
  const df::FixedVector modelled = positionAt(object.motion, m_drawn);
  if (m_ticks == 0 || object.body.solidness != df::HARD || !isMoving(object.motion)) return modelled;
  const auto along = boxAlong(object, m_known, m_drawn);
  if (!along) return modelled;

  std::vector<df::FixedBox> mover;
  mover.reserve(m_ticks + 1);
  appendPlaces(mover, object, m_known, m_ticks);
  std::uint32_t first = m_ticks + 1;  // the tick in which it would first be blocked
  forEachNear(*along, [&](const Solid& other) {
    if (other.order == object.order || !df::intersects(*along, other.along)) return;
    first = firstTouch(mover, object.order, other, first);
  });
  return positionAt(object.motion, m_known + first - 1);
}

df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn) {
  return ExtrapolationClamp(replica, known, drawn).positionOf(object);
}

}  // namespace naiad
