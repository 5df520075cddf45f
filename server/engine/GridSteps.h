// The grid's part in a walker's step: is the place free, and then the box is filed there. Inline, for this is
// what most Objects of a busy world do most of the time.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "Fixed.h"
#include "Grid.h"

namespace df {

/// Steps of boxes, one after another, while nothing else touches the grid and the store's arrays
/// stay where they are: the pointers are held at hand.
class Grid::Steps {
 public:
  explicit Steps(Grid& grid);
  ~Steps() { m_grid.m_paths.nine_cells += m_nine_cells; }
  Steps(const Steps&) = delete;
  Steps& operator=(const Steps&) = delete;
  /// Would `s`, which is filed, touch nobody at `where`? If it would, found() says whom.
  bool isFree(Slot s, FixedVector where) {
    return m_p_records[s].level == 0 ? isCharacterFree(s, where) : isBoxFree(s, m_p_records[s], where);
  }
  /// Whom it touches; in no particular order, and one may come twice.
  std::span<const Slot> found() const {
    return {m_count <= kFew ? m_few.data() : m_grid.m_found.data(), m_count};
  }
  /// File `s`, for which isFree() was asked last, where it wanted to go. Its position must be set.
  void take(Slot s);

 private:
  static constexpr std::size_t kFew = 32;
  bool isCharacterFree(Slot s, FixedVector where);
  bool isBoxFree(Slot s, const Record& own, FixedVector where);
  bool lookAround(Slot s, FixedVector where);
  void lookAtOthers(Slot s, FixedVector where);
  void visit(int level, Slot s, const FixedBox& box);
  void test(Slot t, Slot self, FixedVector low, FixedVector high);
  bool touches(Slot t, FixedVector corner) const;
  void putBack(const Record& own);
  void found(Slot t);

  Grid& m_grid;
  Level& m_level;
  const FixedVector* m_p_positions;
  const FixedBox* m_p_boxes;
  std::uint64_t* m_p_words;
  Record* m_p_records;
  Slot* m_p_heads;
  std::uint32_t m_word_mask;
  std::uint32_t m_cell_mask;
  std::uint32_t m_others;
  std::uint64_t m_nine_cells = 0;
  // Of the last isFree().
  std::uint32_t m_cell = 0;
  bool m_lifted = false;  // its own cell, which nobody shares, is marked empty while it goes
  bool m_plain = false;   // ... and the cell it goes to is empty, too
  std::size_t m_count = 0;
  std::array<Slot, kFew> m_few;
};

inline Grid::Steps::Steps(Grid& grid)
    : m_grid(grid),
      m_level(grid.m_levels[0]),
      m_p_positions(grid.m_positions.data()),
      m_p_boxes(grid.m_boxes.data()),
      m_p_words(m_level.words.data()),
      m_p_records(grid.m_records.data()),
      m_p_heads(m_level.heads.get()),
      m_word_mask(m_level.word_mask),
      m_cell_mask(m_level.word_mask << 6 | 63),
      m_others(grid.m_occupied & ~1u) {}

// A character touches another if the positions are at most one apart on both axes: nine cells. In the inner
// part of the block it comes from, their numbers follow from its own.
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
    return lookAround(s, where);
  }
  const auto step = static_cast<std::uint32_t>((x - own_x) + (y - own_y) * 64);
  m_cell = (own.cell + step) & m_cell_mask;
  const bool alone = (own.next & own.previous) == kNone;
  m_lifted = alone;
  if (alone) m_p_words[own.cell >> 6] &= ~(std::uint64_t{1} << (own.cell & 63));
  const auto middle = m_cell >> 6;
  const unsigned column = (m_cell & 63) - 1;
  const unsigned above = static_cast<unsigned>(m_p_words[(middle - 1) & m_word_mask] >> column) & 7;
  const unsigned level = static_cast<unsigned>(m_p_words[middle] >> column) & 7;
  const unsigned below = static_cast<unsigned>(m_p_words[(middle + 1) & m_word_mask] >> column) & 7;
  unsigned seen = above | level << 3 | below << 6;
  m_plain = alone & ((seen & 16) == 0);
  if (seen != 0) {
    // What touches lies within 2 of the corner that is one up and one to the left.
    const FixedVector corner = where - FixedVector{kFixedOne, kFixedOne};
    std::size_t count = 0;
    for (; seen != 0; seen &= seen - 1) {
      static constexpr std::array<std::int32_t, 9> kNeighbours{-65, -64, -63, -1, 0, 1, 63, 64, 65};
      const auto neighbour =
          static_cast<std::uint32_t>(kNeighbours[static_cast<std::size_t>(std::countr_zero(seen))]);
      const Slot head = m_p_heads[(m_cell + neighbour) & m_cell_mask];
      // Counted, not asked: nobody can foresee the answer.
      const Slot first = head & ~kMore;
      m_few[count] = first;
      count += touches(first, corner) & (first != s) ? 1 : 0;
      if ((head & kMore) == 0) continue;
      for (Slot t = m_p_records[first].next; t != kNone; t = m_p_records[t].next) {
        if (count >= kFew - 9) {
          putBack(own);
          return lookAround(s, where);
        }
        m_few[count] = t;
        count += touches(t, corner) & (t != s) ? 1 : 0;
      }
    }
    m_count = count;
  }
  if (m_others != 0) lookAtOthers(s, where);
  if (m_count == 0) return true;
  putBack(own);
  return false;
}

inline void Grid::Steps::putBack(const Record& own) {
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

inline void Grid::Steps::take(Slot s) {
  if (m_plain) {  // from a cell of its own, which isFree() has emptied, to a free one
    m_p_records[s].cell = m_cell;
    m_p_words[m_cell >> 6] |= std::uint64_t{1} << (m_cell & 63);
    m_p_heads[m_cell] = s;
    return;
  }
  putBack(m_p_records[s]);
  m_grid.refile(s);
}

}  // namespace df
