// The grid's part in the step of a walker (UpdateMasks::walkers): tests whether the target is free, then
// files the box there. Inline, because most Objects of a busy world do this in most ticks.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "engine/collision/Grid.h"
#include "engine/collision/GridCoverageMask.h"
#include "shared/values/Fixed.h"

namespace df {

/// Makes the steps of boxes, one after another. While it exists, nothing else may use the grid, and the world
/// store's arrays must not be reallocated, because their addresses are kept in members.
class Grid::Steps {
 public:
  /// found() lists all touching slots if there are at most `most`, else only some, but more than `most`.
  explicit Steps(Grid& grid, std::size_t most = kAll);
  ~Steps() { m_grid.m_mover_stats.nine_cells += m_nine_cells; }
  Steps(const Steps&) = delete;
  Steps& operator=(const Steps&) = delete;
  /// True if the filed slot `s` would touch nothing at `where`; else found() lists the slots it would touch.
  bool isFree(Slot s, FixedVector where) {
    return m_p_records[s].level == 0 ? isCharacterFree(s, where) : isBoxFree(s, m_p_records[s], where);
  }
  /// Returns the slots that the last isFree() found, in no particular order; a slot may appear twice.
  std::span<const Slot> found() const {
    return {m_count <= kFew ? m_few.data() : m_grid.m_found.data(), m_count};
  }
  /// Files `s` at `where`, the arguments of the last isFree(). The caller must have moved `s` there.
  void fileAtTarget(Slot s);

 private:
  static constexpr std::size_t kFew = 32;
  class Nine;
  bool isCharacterFree(Slot s, FixedVector where);
  bool gather(Slot s, FixedVector where, unsigned near);
  bool isBoxFree(Slot s, const Record& own, FixedVector where);
  bool findAround(Slot s, FixedVector where);
  /// True if a character in `cell` of level 0, whose bit is in `word`, may touch boxes of other levels.
  bool mayTouchOthers(std::uint32_t word, std::uint32_t cell) const {
    return m_others != 0 && (m_p_coverage[word] >> (cell & 63) & 1) != 0;
  }
  void findInOtherLevels(Slot s, FixedVector where);
  void visit(int level, Slot s, const FixedBox& box);
  void test(Slot t, Slot self, FixedVector low, FixedVector high);
  bool touches(Slot t, FixedVector corner) const;
  void restoreCell(const Record& own);
  void found(Slot t);

  Grid& m_grid;
  std::size_t m_limit;
  Level& m_level;
  const FixedVector* m_p_positions;
  const FixedBox* m_p_boxes;
  std::uint64_t* m_p_words;
  Record* m_p_records;
  Slot* m_p_heads;
  Spot* m_p_spots;
  std::uint32_t m_cell_mask;
  std::uint32_t m_others;
  const std::uint64_t* m_p_coverage;  // null if the other levels are empty
  std::uint64_t m_nine_cells = 0;
  // State of the last isFree().
  std::uint32_t m_cell = 0;
  bool m_lifted = false;  // the mover is alone in its cell, which is marked empty for now
  bool m_plain = false;   // m_lifted, and the target cell is empty, too
  std::size_t m_count = 0;
  std::array<Slot, kFew> m_few;
};

// Finds by their spots which of the characters in nine cells touch one in the middle cell. Tests all nine at
// once, because a branch for each would be mispredicted. Bits 0 to 2 are the row above, 4 to 6 the row below,
// 8 to 10 the row between, from left to right.
class Grid::Steps::Nine {
 public:
  static constexpr unsigned kMiddle = 1 << 9;
  /// Steps from the middle to the cell of each bit.
  static constexpr std::array<std::int32_t, 11> kSteps{-65, -64, -63, 0, 63, 64, 65, 0, -1, 0, 1};

  /// The pointers are to the left spot of each row: kRowOfSpots of a row are read, occupied or not. `middle`
  /// is the spot of the character in the middle cell.
  Nine(const Spot* p_above, const Spot* p_own, const Spot* p_below, Spot middle) {
    const Eight outer = load(p_above, p_below);
    const Eight inner = load(p_own, p_own);
    const Eight x = Eight{} + static_cast<std::int16_t>(middle & 0xFF);
    const Eight y = Eight{} + static_cast<std::int16_t>(middle >> 8);
    const Eight outer_x = outer & 0xFF;
    const Eight outer_y = outer >> 8 & 0x7F;
    const Eight inner_x = inner & 0xFF;
    // A character on the left is too far if it is farther left in its cell than the middle one is in its own
    // cell; accordingly for the right, above and below.
    constexpr Eight kLeft{-1, 0, 0, 0, -1, 0, 0, 0};
    constexpr Eight kRight{0, 0, -1, 0, 0, 0, -1, 0};
    constexpr Eight kAbove{-1, -1, -1, -1, 0, 0, 0, 0};
    const Eight far_outer = ((outer_x < x) & kLeft) | ((outer_x > x) & kRight) | ((outer_y < y) & kAbove) |
                            ((outer_y > y) & ~kAbove);
    const Eight far_inner = ((inner_x < x) & kLeft) | ((inner_x > x) & kRight);
    m_near = ~bits(far_outer, far_inner) | bits(outer, inner);  // a cell with kSeveral always counts as near
  }
  /// Returns the bits of the cells whose character may touch. The character does touch, unless it misses by
  /// less than the resolution of spots, or is a neighbour only on the torus (Grid.h).
  unsigned near() const { return m_near; }

 private:
  using Eight = std::int16_t __attribute__((vector_size(16)));

  static Eight load(const Spot* p_low, const Spot* p_high) {
    std::array<std::uint64_t, 2> rows;
    std::memcpy(&rows[0], p_low, sizeof rows[0]);
    std::memcpy(&rows[1], p_high, sizeof rows[1]);
    using Two = std::uint64_t __attribute__((vector_size(16)));
    const Two two{rows[0], rows[1]};
    Eight eight;
    std::memcpy(&eight, &two, sizeof eight);
    return eight;
  }
  /// Returns the sign bits of the numbers.
  static unsigned bits(Eight low, Eight high) {
#if defined(__SSE2__)
    return static_cast<unsigned>(
        _mm_movemask_epi8(_mm_packs_epi16(reinterpret_cast<__m128i>(low), reinterpret_cast<__m128i>(high))));
#else
    unsigned all = 0;
    for (int i = 0; i < 8; ++i) all |= (low[i] < 0 ? 1u << i : 0) | (high[i] < 0 ? 256u << i : 0);
    return all;
#endif
  }

  unsigned m_near = 0;
};

inline Grid::Steps::Steps(Grid& grid, std::size_t most)
    : m_grid(grid),
      m_limit(most),
      m_level(grid.m_levels[0]),
      m_p_positions(grid.m_positions.data()),
      m_p_boxes(grid.m_boxes.data()),
      m_p_words(m_level.words.data()),
      m_p_records(grid.m_records.data()),
      m_p_heads(m_level.heads.get()),
      m_p_spots(m_level.spots.get()),
      m_cell_mask(m_level.word_mask << 6 | 63),
      m_others(grid.m_occupied & ~1u),
      m_p_coverage(grid.m_p_coverage != nullptr ? grid.m_p_coverage->words() : nullptr) {}

// A character touches another if their positions differ by at most one on both axes, so the other is in one
// of nine cells. In the inner part of the mover's block, their indices follow from that of its own cell.
inline bool Grid::Steps::isCharacterFree(Slot s, FixedVector where) {
  const FixedVector from = m_p_positions[s];
  const std::int64_t x = where.x >> kFixedBits;
  const std::int64_t y = where.y >> kFixedBits;
  const std::int64_t own_x = from.x >> kFixedBits;
  const std::int64_t own_y = from.y >> kFixedBits;
  const Record& own = m_p_records[s];
  m_count = 0;
  const bool same_block = (((x ^ own_x) | (y ^ own_y)) & ~std::int64_t{63}) == 0;
  const bool inner = (((x - 1) & 63) <= 61) & (((y - 1) & 63) <= 61);
  ++m_nine_cells;
  if (!(same_block & inner)) {
    m_lifted = m_plain = false;
    return findAround(s, where);
  }
  const auto step = static_cast<std::uint32_t>((x - own_x) + (y - own_y) * 64);
  m_cell = (own.cell + step) & m_cell_mask;
  const bool alone = (own.next & own.previous) == kNone;
  m_lifted = alone;
  if (alone) m_p_words[own.cell >> 6] &= ~(std::uint64_t{1} << (own.cell & 63));
  const std::uint32_t before = m_cell - 1;
  const auto rowOf = [&](std::uint32_t first) {
    return static_cast<unsigned>(m_p_words[first >> 6] >> (first & 63)) & 7;
  };
  const std::uint32_t above = (before - 64) & m_cell_mask;
  const std::uint32_t below = (before + 64) & m_cell_mask;
  // Bits as in Nine: the row above, the row below, the mover's own row.
  const unsigned seen = rowOf(above) | rowOf(below) << 4 | rowOf(before) << 8;
  m_plain = alone & ((seen & Nine::kMiddle) == 0);
  if (seen != 0) {
    unsigned near = seen;
    if (m_p_spots != nullptr) {
      near &= Nine(m_p_spots + above, m_p_spots + before, m_p_spots + below, spotOf(where)).near();
    }
    if (near != 0 && !gather(s, where, near)) {
      restoreCell(own);
      return findAround(s, where);
    }
  }
  if (mayTouchOthers(m_cell >> 6, m_cell)) findInOtherLevels(s, where);
  if (m_count == 0) return true;
  restoreCell(own);
  return false;
}

// Collects the slots in the cells of `near` that touch. Returns false if there are too many.
inline bool Grid::Steps::gather(Slot s, FixedVector where, unsigned near) {
  // Touching characters lie within 2 of the corner that is one up and one to the left.
  const FixedVector corner = where - FixedVector{kFixedOne, kFixedOne};
  std::size_t count = 0;
  for (; near != 0; near &= near - 1) {
    const auto neighbour =
        static_cast<std::uint32_t>(Nine::kSteps[static_cast<std::size_t>(std::countr_zero(near))]);
    const Slot head = m_p_heads[(m_cell + neighbour) & m_cell_mask];
    const Slot first = head & ~kMore;
    m_few[count] = first;
    count += (touches(first, corner) & (first != s)) ? 1 : 0;
    if ((head & kMore) == 0) continue;
    for (Slot t = m_p_records[first].next; t != kNone; t = m_p_records[t].next) {
      if (count >= kFew - 9) return false;
      m_few[count] = t;
      count += (touches(t, corner) & (t != s)) ? 1 : 0;
    }
  }
  m_count = count;
  return true;
}

inline void Grid::Steps::restoreCell(const Record& own) {
  if (m_lifted) m_p_words[own.cell >> 6] |= std::uint64_t{1} << (own.cell & 63);
  m_lifted = m_plain = false;
}

inline bool Grid::Steps::touches(Slot t, FixedVector corner) const {
  const FixedVector d = m_p_positions[t] - corner;
  constexpr auto kTwo = static_cast<std::uint64_t>(2 * kFixedOne);
  return (static_cast<std::uint64_t>(d.x) <= kTwo) & (static_cast<std::uint64_t>(d.y) <= kTwo);
}

inline void Grid::Steps::found(Slot t) {
  if (m_count < kFew) {
    m_few[m_count] = t;
  } else {
    if (m_count == kFew) m_grid.m_found.assign(m_few.begin(), m_few.end());
    m_grid.m_found.push_back(t);
  }
  ++m_count;
}

inline void Grid::Steps::fileAtTarget(Slot s) {
  if (m_plain) {  // `s` was alone in its cell, which isFree() has marked empty, and the target cell is empty
    m_p_records[s].cell = m_cell;
    m_p_words[m_cell >> 6] |= std::uint64_t{1} << (m_cell & 63);
    m_p_heads[m_cell] = s;
    if (m_p_spots != nullptr) m_p_spots[m_cell] = spotOf(m_p_positions[s]);
    return;
  }
  restoreCell(m_p_records[s]);
  m_grid.refile(s);
}

}  // namespace df
