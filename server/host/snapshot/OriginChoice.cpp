#include "host/snapshot/OriginChoice.h"

#include <bit>

namespace naiad {

namespace {

/// Cells by which a window exceeds the view, at least.
constexpr std::int64_t kMargin = 8;
/// Orders farther than this from the window's take too many bits.
constexpr std::uint64_t kFarOrder = 1 << 14;

bool covers(std::int32_t from, std::int32_t bits, std::int32_t low, std::int32_t extent) {
  return low >= from && std::int64_t{low} + extent <= std::int64_t{from} + (std::int64_t{1} << bits);
}

std::int32_t bitsFor(std::int32_t extent) {
  return static_cast<std::int32_t>(std::bit_width(static_cast<std::uint32_t>(extent + kMargin - 1)));
}

}  // namespace

std::uint32_t OriginChoice::updateWindow(CellPosition view_corner, const WorldRecord& world,
                                         std::uint64_t newest_order) {
  const Origin& newest = m_origins[m_newest];
  if (m_newest != 0 && covers(newest.corner.x, newest.x_bits, view_corner.x, world.view_width) &&
      covers(newest.corner.y, newest.y_bits, view_corner.y, world.view_height) &&
      newest_order - newest.order < kFarOrder) {
    return 0;
  }
  // A slot that is unconfirmed may be set again, since no snapshot names it yet.
  const bool pending = m_newest != m_slot;
  if (!pending) m_newest = m_newest % kOriginSlots + 1;
  Origin& origin = m_origins[m_newest];
  origin.x_bits = bitsFor(world.view_width);
  origin.y_bits = bitsFor(world.view_height);
  origin.corner.x = view_corner.x - ((1 << origin.x_bits) - world.view_width) / 2;
  origin.corner.y = view_corner.y - ((1 << origin.y_bits) - world.view_height) / 2;
  origin.order = newest_order;
  return m_newest;
}

void OriginChoice::confirmArrival(std::uint32_t slot) {
  if (slot == m_newest) m_slot = m_newest;
}

}  // namespace naiad
