#include "engine/collision/GridSteps.h"

namespace df {

// Does the work of isCharacterFree() if the nine cells lie in more than one block or contain many characters.
bool Grid::Steps::findAround(Slot s, FixedVector where) {
  --m_nine_cells;
  ++m_grid.m_mover_stats.far_cells;
  const FixedVector corner = where + kCharacterBox.corner;
  const FixedVector one{kFixedOne, kFixedOne};
  m_grid.visitCorners(0, corner - one, corner + one, [&](Slot t) {
    if (t != s && touches(t, where - one)) found(t);
    return m_count <= m_limit;
  });
  if (m_others != 0) {
    const std::int64_t x = where.x >> kFixedBits;
    const std::uint32_t word = m_level.wordOf(x, where.y >> kFixedBits);
    if (mayTouchOthers(word, static_cast<std::uint32_t>(x))) findInOtherLevels(s, where);
  }
  return m_count == 0;
}

void Grid::Steps::findInOtherLevels(Slot s, FixedVector where) {
  const FixedBox box = translate(kCharacterBox, where);
  for (std::uint32_t left = m_others; left != 0; left &= left - 1) visit(std::countr_zero(left), s, box);
}

// The cells to search form a window that is a few cells wide and high. As for characters, their indices
// follow from that of the box's own cell if the window lies in one block.
bool Grid::Steps::isBoxFree(Slot s, const Record& own, FixedVector where) {
  m_count = 0;
  m_lifted = m_plain = false;
  const Level& level = m_grid.m_levels[own.level];
  const FixedBox box = translate(m_grid.m_boxes[s], where);
  const FixedVector low = box.corner - largest(own.level);
  const FixedVector high = box.corner + box.size;
  const FixedVector from = m_p_positions[s] + m_grid.m_boxes[s].corner;
  const std::int64_t own_x = from.x >> level.x_shift;
  const std::int64_t own_y = from.y >> level.y_shift;
  const std::int64_t x0 = low.x >> level.x_shift;
  const std::int64_t y0 = low.y >> level.y_shift;
  const std::int64_t x1 = high.x >> level.x_shift;
  const std::int64_t y1 = high.y >> level.y_shift;
  const bool same_block =
      (((x0 ^ own_x) | (x1 ^ own_x) | (y0 ^ own_y) | (y1 ^ own_y)) & ~std::int64_t{63}) == 0;
  std::uint32_t others = m_grid.m_occupied;
  ++(same_block ? m_grid.m_mover_stats.few_cells : m_grid.m_mover_stats.far_cells);
  if (same_block) {
    others &= ~(1u << own.level);
    const std::uint64_t* p_words = level.words.data();
    const std::uint32_t cell_mask = level.word_mask << 6 | 63;
    const auto corner = own.cell + static_cast<std::uint32_t>((x0 - own_x) + (y0 - own_y) * 64);
    const auto width = static_cast<unsigned>(x1 - x0);
    for (std::uint32_t row = 0; row <= static_cast<std::uint32_t>(y1 - y0); ++row) {
      const std::uint32_t first = (corner + row * 64) & cell_mask;
      for (std::uint64_t seen = p_words[first >> 6] >> (first & 63) & ((std::uint64_t{2} << width) - 1);
           seen != 0; seen &= seen - 1) {
        const Slot head = level.heads[first + static_cast<std::uint32_t>(std::countr_zero(seen))];
        test(head & ~kMore, s, box.corner, high);
        if ((head & kMore) == 0) continue;
        for (Slot t = m_p_records[head & ~kMore].next; t != kNone; t = m_p_records[t].next) {
          test(t, s, box.corner, high);
          if (m_count > m_limit) return false;
        }
      }
    }
  }
  for (; others != 0 && m_count <= m_limit; others &= others - 1) visit(std::countr_zero(others), s, box);
  return m_count == 0;
}

inline void Grid::Steps::test(Slot t, Slot self, FixedVector low, FixedVector high) {
  const FixedVector corner = m_p_positions[t] + m_p_boxes[t].corner;
  const FixedVector far = corner + m_p_boxes[t].size;
  // They touch if none of the four differences is negative.
  const Fixed apart = (high.x - corner.x) | (far.x - low.x) | (high.y - corner.y) | (far.y - low.y);
  const bool touches = (apart >= 0) & (t != self);
  if (m_count < kFew) {  // arithmetic in place of an unpredictable branch
    m_few[m_count] = t;
    m_count += touches ? 1 : 0;
  } else if (touches) {
    found(t);
  }
}

void Grid::Steps::visit(int level, Slot s, const FixedBox& box) {
  const FixedVector high = box.corner + box.size;
  m_grid.visitCorners(level, box.corner - largest(level), high, [&](Slot t) {
    test(t, s, box.corner, high);
    return m_count <= m_limit;
  });
}

}  // namespace df
