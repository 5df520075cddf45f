#include "ExtrapolationClamp.h"

#include <algorithm>

#include "Acks.h"
#include "Surroundings.h"

namespace naiad {

namespace {

constexpr std::int64_t kCellWidth = 8;  // in characters
constexpr std::int64_t kCellHeight = 4;
constexpr std::int64_t kMostCells = 64;

struct Range {
  std::int64_t left, top, right, bottom;
  std::int64_t count() const { return (right - left + 1) * (bottom - top + 1); }
};

Range cellsOf(const df::FixedBox& box) {
  const auto down = [](df::Fixed v, std::int64_t cells) {
    return (v >> df::kFixedBits) / cells - ((v >> df::kFixedBits) % cells < 0 ? 1 : 0);
  };
  return {down(box.corner.x, kCellWidth), down(box.corner.y, kCellHeight),
          down(box.corner.x + box.size.x, kCellWidth), down(box.corner.y + box.size.y, kCellHeight)};
}

std::uint64_t cellKey(std::int64_t x, std::int64_t y) {
  return static_cast<std::uint64_t>(x) << 32 | static_cast<std::uint32_t>(y);
}

}  // namespace

ExtrapolationClamp::ExtrapolationClamp(const Replica& replica, std::uint32_t known, std::uint32_t drawn)
    : m_known(known), m_drawn(drawn) {
  if (!isNewer(drawn, known) || drawn - known > kMaxTicks) return;
  for (const auto& [slot, entry] : replica.entries()) {
    if (!entry.alive || entry.state.body.solidness != df::HARD) continue;
    const auto along = boxAlong(entry.state, known, drawn);
    if (along) m_solids.push_back({&entry.state, *along});
  }
  for (std::uint32_t i = 0; i < m_solids.size(); ++i) sort(m_solids[i], i);
  std::sort(m_cells.begin(), m_cells.end());
}

void ExtrapolationClamp::sort(const Solid& solid, std::uint32_t index) {
  const Range range = cellsOf(solid.along);
  if (range.count() > kMostCells) {
    m_large.push_back(index);
    return;
  }
  for (std::int64_t y = range.top; y <= range.bottom; ++y) {
    for (std::int64_t x = range.left; x <= range.right; ++x) m_cells.emplace_back(cellKey(x, y), index);
  }
}

/// Calls `visit` for all solids that may touch the box, for some of them more than once.
template <class Visit>
void ExtrapolationClamp::forEachNear(const df::FixedBox& box, Visit visit) const {
  const Range range = cellsOf(box);
  if (range.count() > kMostCells) {
    for (const Solid& solid : m_solids) visit(solid);
    return;
  }
  for (const std::uint32_t index : m_large) visit(m_solids[index]);
  for (std::int64_t y = range.top; y <= range.bottom; ++y) {
    for (std::int64_t x = range.left; x <= range.right; ++x) {
      const Cell key = cellKey(x, y);
      auto at = std::lower_bound(m_cells.begin(), m_cells.end(), std::pair<Cell, std::uint32_t>(key, 0));
      for (; at != m_cells.end() && at->first == key; ++at) visit(m_solids[at->second]);
    }
  }
}

/// Would the mover, where it is at the end of `tick`, touch the other, as that is at its turn?
bool ExtrapolationClamp::enters(const ObjectState& mover, const ObjectState& other,
                                std::uint32_t tick) const {
  const auto own = boxAt(mover.body, positionAt(mover.motion, tick));
  const bool other_is_first = tick == m_known || other.order < mover.order;
  const auto its = boxAt(other.body, positionAt(other.motion, other_is_first ? tick : tick - 1));
  return own && its && df::intersects(*own, *its);
}

df::FixedVector ExtrapolationClamp::positionOf(const ObjectState& object) const {
  const df::FixedVector modelled = positionAt(object.motion, m_drawn);
  if (m_solids.empty() || object.body.solidness != df::HARD || !isMoving(object.motion)) return modelled;
  const auto along = boxAlong(object, m_known, m_drawn);
  if (!along) return modelled;

  std::uint32_t first = m_drawn + 1;  // the tick in which it would first be blocked
  forEachNear(*along, [&](const Solid& solid) {
    const ObjectState& other = *solid.p_object;
    if (other.order == object.order || !df::intersects(*along, solid.along)) return;
    if (enters(object, other, m_known)) return;
    for (std::uint32_t tick = m_known + 1; tick != first; ++tick) {
      if (!enters(object, other, tick)) continue;
      first = tick;
      return;
    }
  });
  return positionAt(object.motion, first - 1);
}

df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn) {
  return ExtrapolationClamp(replica, known, drawn).positionOf(object);
}

}  // namespace naiad
