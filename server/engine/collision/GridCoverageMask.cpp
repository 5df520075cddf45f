#include "engine/collision/GridCoverageMask.h"

namespace df {

std::uint16_t Grid::CoverageMask::areaOf(const FixedBox& box) {
  const auto cells = [](Fixed size) { return static_cast<std::uint64_t>(size >> kFixedBits) + 3; };
  const std::uint64_t wide = cells(box.size.x), high = cells(box.size.y);
  if (wide > kMaxArea || high > kMaxArea || wide * high > kMaxArea) return 0;
  return static_cast<std::uint16_t>(wide * high);
}

Grid::CoverageMask::CoverageMask(const Level& level, bool is_exact)
    : m_is_exact(is_exact),
      m_size(level.words.size()),
      m_words(is_exact ? m_size : 0),
      m_counts(is_exact ? 64 * m_size : 0) {
  cover(false);
}

void Grid::CoverageMask::cover(bool is_covered) {
  m_are_set = is_covered || !m_is_exact;
  if (m_are_set && m_ones.empty()) m_ones.assign(m_size, ~std::uint64_t{0});
}

void Grid::CoverageMask::count(const Level& level, const Area& area, bool is_more) {
  for (std::int64_t y = area.y0; y <= area.y1; ++y) {
    for (std::int64_t x = area.x0; x <= area.x1;) {
      const std::int64_t end = (x | 63) < area.x1 ? x | 63 : area.x1;
      const std::uint32_t word = level.wordOf(x, y);
      for (; x <= end; ++x) {
        const auto bit = static_cast<std::uint32_t>(x & 63);
        std::uint8_t& its = m_counts[std::size_t{word} << 6 | bit];
        if (its == kMaxCount) continue;
        its = static_cast<std::uint8_t>(is_more ? its + 1 : its - 1);
        const std::uint64_t mask = std::uint64_t{1} << bit;
        m_words[word] = its != 0 ? m_words[word] | mask : m_words[word] & ~mask;
      }
    }
  }
}

void Grid::CoverageMask::file(const Level& level, Slot slot, const FixedBox& box) {
  if (slot >= m_index.size()) m_index.resize(slot + 1, kNowhere);
  // A character touches a box if its position is at most half a cell away, edges included.
  const FixedVector low = box.corner + kCharacterBox.corner;
  const FixedVector high = box.corner + box.size - kCharacterBox.corner;
  const auto cell = [](Fixed at) { return at >> kFixedBits; };
  const Area area{slot, cell(low.x), cell(low.y), cell(high.x), cell(high.y)};
  std::uint32_t& index = m_index[slot];
  if (index == kNowhere) {
    index = static_cast<std::uint32_t>(m_areas.size());
    m_areas.push_back(area);
  } else {
    if (m_areas[index] == area) return;
    count(level, m_areas[index], false);
    m_areas[index] = area;
  }
  count(level, area, true);
}

void Grid::CoverageMask::remove(const Level& level, Slot slot) {
  if (slot >= m_index.size() || m_index[slot] == kNowhere) return;
  const std::uint32_t index = m_index[slot];
  count(level, m_areas[index], false);
  m_areas[index] = m_areas.back();
  m_index[m_areas[index].slot] = index;
  m_index[slot] = kNowhere;
  m_areas.pop_back();
}

}  // namespace df
