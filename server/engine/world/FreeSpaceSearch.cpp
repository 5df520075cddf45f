#include "engine/world/FreeSpaceSearch.h"

#include <algorithm>
#include <bit>

namespace df {

namespace {

constexpr std::int64_t kFirstReach = 4;

std::int64_t floorCells(Fixed length) {
  return length >> kFixedBits;
}

std::int64_t ceilCells(Fixed length) {
  return (length + kFixedOne - 1) >> kFixedBits;
}

}  // namespace

FreeSpaceSearch::Range FreeSpaceSearch::Range::within(const Range& other) const {
  return {std::max(first, other.first), std::min(last, other.last)};
}

// Returns the offsets with which the box lies inside the boundary, on one axis.
FreeSpaceSearch::Range FreeSpaceSearch::inside(Fixed low, Fixed size, Fixed boundary_low,
                                               Fixed boundary_size) {
  return {ceilCells(boundary_low - low), floorCells(boundary_low + boundary_size - size - low)};
}

// Returns the offsets with which the box touches another box, on one axis.
FreeSpaceSearch::Range FreeSpaceSearch::taken(Fixed low, Fixed size, Fixed other_low, Fixed other_size) {
  return {ceilCells(other_low - size - low), floorCells(other_low + other_size - low)};
}

std::optional<FixedVector> FreeSpaceSearch::nearest() {
  const Range xs = inside(m_box.corner.x, m_box.size.x, m_boundary.corner.x, m_boundary.size.x);
  const Range ys = inside(m_box.corner.y, m_box.size.y, m_boundary.corner.y, m_boundary.size.y);
  for (std::int64_t reach = kFirstReach;; reach = std::min(2 * reach, kReach)) {
    mark(xs.within({-reach, reach}), ys.within({-reach, reach}));
    const std::optional<Offset> found = nearestInTable();
    // An offset further than `reach` is not the result yet, because one outside the square may be nearer.
    if (found && (found->square() <= reach * reach || reach == kReach)) {
      return FixedVector{found->x * kFixedOne, found->y * kFixedOne};
    }
    if (reach == kReach) return std::nullopt;
  }
}

// Makes the table of free offsets in these ranges.
void FreeSpaceSearch::mark(const Range& xs, const Range& ys) {
  m_xs = xs;
  m_ys = ys;
  m_free.clear();
  if (xs.first > xs.last || ys.first > ys.last) return;
  const std::int64_t width = xs.last - xs.first + 1;
  m_words = (width + 63) / 64;
  m_free.assign(static_cast<std::size_t>(m_words * (ys.last - ys.first + 1)), ~std::uint64_t{0});

  const FixedBox reached = {
      m_box.corner + FixedVector{xs.first * kFixedOne, ys.first * kFixedOne},
      m_box.size + FixedVector{(width - 1) * kFixedOne, (ys.last - ys.first) * kFixedOne}};
  m_near.clear();
  m_store.grid().touching(reached, WorldStore::kNoSlot, m_near);
  for (const WorldStore::Slot s : m_near) {
    const FixedBox other = m_store.worldBox(s, m_store.position(s));
    markTaken(taken(m_box.corner.x, m_box.size.x, other.corner.x, other.size.x).within(xs),
              taken(m_box.corner.y, m_box.size.y, other.corner.y, other.size.y).within(ys));
  }
}

void FreeSpaceSearch::markTaken(const Range& xs, const Range& ys) {
  if (xs.first > xs.last) return;
  const std::int64_t first = xs.first - m_xs.first;
  const std::int64_t last = xs.last - m_xs.first;
  for (std::int64_t y = ys.first; y <= ys.last; ++y) {
    std::uint64_t* p_row = &m_free[static_cast<std::size_t>((y - m_ys.first) * m_words)];
    for (std::int64_t word = first / 64; word <= last / 64; ++word) {
      std::uint64_t bits = ~std::uint64_t{0};
      if (word == first / 64) bits &= ~std::uint64_t{0} << (first % 64);
      if (word == last / 64) bits &= ~std::uint64_t{0} >> (63 - last % 64);
      p_row[word] &= ~bits;
    }
  }
}

// Returns the free offset of this row that is nearest to 0; of two equally near ones, the smaller.
std::optional<std::int64_t> FreeSpaceSearch::nearestInRow(std::int64_t y) const {
  const std::uint64_t* p_row = &m_free[static_cast<std::size_t>((y - m_ys.first) * m_words)];
  const std::int64_t width = m_xs.last - m_xs.first + 1;
  const std::int64_t zero = std::clamp<std::int64_t>(-m_xs.first, 0, width - 1);
  std::optional<std::int64_t> nearest;
  for (std::int64_t word = zero / 64; word >= 0; --word) {
    std::uint64_t bits = p_row[word];
    if (word == zero / 64) bits &= ~std::uint64_t{0} >> (63 - zero % 64);
    if (bits == 0) continue;
    nearest = m_xs.first + word * 64 + 63 - std::countl_zero(bits);
    break;
  }
  for (std::int64_t word = zero / 64; word < m_words; ++word) {
    std::uint64_t bits = p_row[word];
    if (word == zero / 64) bits &= ~std::uint64_t{0} << (zero % 64);
    if (bits == 0) continue;
    const std::int64_t x = m_xs.first + word * 64 + std::countr_zero(bits);
    if (x <= m_xs.last && (!nearest || std::abs(x) < std::abs(*nearest))) nearest = x;
    break;
  }
  return nearest;
}

std::optional<FreeSpaceSearch::Offset> FreeSpaceSearch::nearestInTable() const {
  std::optional<Offset> nearest;
  if (m_free.empty()) return nearest;
  const auto lookAt = [&](std::int64_t y) {
    if (y < m_ys.first || y > m_ys.last) return;
    const std::optional<std::int64_t> x = nearestInRow(y);
    if (!x) return;
    const Offset offset{*x, y};
    const bool nearer = !nearest || offset.square() < nearest->square();
    const bool above = nearest && offset.square() == nearest->square() && y < nearest->y;
    if (nearer || above) nearest = offset;
  };
  const std::int64_t most = std::max(std::abs(m_ys.first), std::abs(m_ys.last));
  lookAt(0);
  for (std::int64_t y = 1; y <= most && (!nearest || y * y <= nearest->square()); ++y) {
    lookAt(-y);
    lookAt(y);
  }
  return nearest;
}

}  // namespace df
