#include "engine/world/ViewCover.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace df {

namespace {

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

std::int64_t floorCell(Fixed value) {
  return value >> kFixedBits;
}

}  // namespace

ViewCover::ViewCover(const std::vector<FixedVector>& corners, FixedVector size) : m_size(size) {
  assert(size.x > 0 && size.y > 0);
  m_corners.reserve(corners.size());
  for (const FixedVector at : corners) m_corners.push_back({rowOf(at.y), columnOf(at.x), at});
  const auto place = [](const Corner& c) { return std::tuple(c.row, c.column, c.at.y, c.at.x); };
  std::sort(m_corners.begin(), m_corners.end(),
            [&](const Corner& a, const Corner& b) { return place(a) < place(b); });
  const auto end = std::unique(m_corners.begin(), m_corners.end(),
                               [](const Corner& a, const Corner& b) { return a.at == b.at; });
  m_corners.erase(end, m_corners.end());
  if (m_corners.size() > kFew) markBlocks();
}

std::int64_t ViewCover::columnOf(Fixed x) const {
  return floorDivide(x, m_size.x);
}
std::int64_t ViewCover::rowOf(Fixed y) const {
  return floorDivide(y, m_size.y);
}

void ViewCover::markBlocks() {
  const auto low = [](std::int64_t cell, int shift) {
    return (cell + (std::int64_t{1} << shift) - 1) >> shift;
  };
  const std::int64_t width = floorCell(m_size.x);
  const std::int64_t height = floorCell(m_size.y);
  std::int64_t right = INT64_MIN;
  std::int64_t bottom = INT64_MIN;
  m_left = m_top = INT64_MAX;
  for (const Corner& corner : m_corners) {
    m_left = std::min(m_left, low(floorCell(corner.at.x), kColumnShift));
    m_top = std::min(m_top, low(floorCell(corner.at.y), kRowShift));
    right = std::max(right, (floorCell(corner.at.x) + width) >> kColumnShift);
    bottom = std::max(bottom, (floorCell(corner.at.y) + height) >> kRowShift);
  }
  if (right - m_left > kMaxBlocks || bottom - m_top > kMaxBlocks) return;
  if ((right - m_left) * (bottom - m_top) > kMaxBlocks) return;
  m_columns = right - m_left;
  m_rows = bottom - m_top;
  m_marked.resize(static_cast<std::size_t>(m_columns * m_rows));
  for (const Corner& corner : m_corners) {
    const std::int64_t x = floorCell(corner.at.x);
    const std::int64_t y = floorCell(corner.at.y);
    const std::int64_t columns = ((x + width) >> kColumnShift) - low(x, kColumnShift);
    for (std::int64_t row = low(y, kRowShift); row < (y + height) >> kRowShift; ++row) {
      const auto begin = m_marked.begin() + ((row - m_top) * m_columns + low(x, kColumnShift) - m_left);
      std::fill_n(begin, columns, true);
    }
  }
}

bool ViewCover::isMarked(FixedVector point) const {
  const std::int64_t column = (floorCell(point.x) >> kColumnShift) - m_left;
  const std::int64_t row = (floorCell(point.y) >> kRowShift) - m_top;
  if (column < 0 || row < 0 || column >= m_columns || row >= m_rows) return false;
  return m_marked[static_cast<std::size_t>(row * m_columns + column)];
}

bool ViewCover::intersectsAny(const FixedBox& box) const {
  const auto meets = [&](const Corner& corner) { return intersects(box, {corner.at, m_size}); };
  if (m_corners.size() <= kFew) return std::any_of(m_corners.begin(), m_corners.end(), meets);
  if (isMarked(box.corner)) return true;
  const std::int64_t left = columnOf(box.corner.x - m_size.x);
  const std::int64_t right = columnOf(box.corner.x + box.size.x);
  const std::int64_t bottom = rowOf(box.corner.y + box.size.y);
  // Searches only rows that have corners, because a box larger than all views together would have many rows.
  const std::int64_t first = std::max(rowOf(box.corner.y - m_size.y), m_corners.front().row);
  const std::int64_t last = std::min(bottom, m_corners.back().row);
  for (std::int64_t row = first; row <= last; ++row) {
    auto corner = std::lower_bound(
        m_corners.begin(), m_corners.end(), std::pair(row, left),
        [](const Corner& c, const auto& wanted) { return std::pair(c.row, c.column) < wanted; });
    for (; corner != m_corners.end() && corner->row == row && corner->column <= right; ++corner) {
      if (meets(*corner)) return true;
    }
  }
  return false;
}

}  // namespace df
