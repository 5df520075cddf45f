// The broad phase: finds the solid boxes that may touch a box.
//
// Each box is filed once, by its upper left corner, in a level that depends on its size. Level 0 is for
// single characters and has cells of 1 by 1, so that a query looks at nine cells. Level 1 is for boxes up to
// 16 by 4, because text is wider than high; each further level is for boxes up to four times as large on both
// axes. Cells are a quarter as wide and half as high as the largest boxes of their level. If few boxes are
// characters, these are filed in level 1 too, so that there is one level less to search.
//
// A level has two arrays: one bit per cell, set if it is occupied, with 64 cells of a row in a word and then
// the words of the rows below; and the first slot of each cell. Nine cells are looked up in three
// neighbouring words. Level 0 has a third array with the spot of each cell: the place of its character within
// the cell, in 15 bits. Because of the spots, only those of the nine characters are read that touch, or
// almost touch. (The array is missing if characters are few and far apart.)
//
// The world's cells are mapped onto the arrays as onto a torus: the last column or row of the arrays is
// followed by the first one again (a turn). The part of the world over which the boxes of a level are spread
// is mapped without a turn, if there is room. Cells that are one or more turns apart share entries, shifted
// by a hash; the exact test then distinguishes their boxes. So the arrays have 32 to 64 cells per box,
// wherever the boxes are. Queries read only occupied cells. Nothing is allocated when a box moves.
//
// When a character moves, the other levels are searched only if a bit of its cell of level 0 says that one of
// their boxes may be there (GridCoverageMask.h). The bits are kept while such boxes cover few cells.
//
// The grid reads positions and boxes from the world store's arrays. A slot is filed under the values that
// they had at its last file() or refile().
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/collision/MoverStats.h"
#include "shared/values/Fixed.h"

namespace df {

/// A single character: one cell, centred on the position.
inline constexpr FixedBox kCharacterBox{{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}};

class Grid {
  struct Level;
  struct Record;
  using Spot = std::uint16_t;

 public:
  using Slot = std::uint32_t;
  static constexpr int kLevels = 12;
  class Steps;

  /// Slots are indices of both arrays, which must outlive the grid.
  Grid(const std::vector<FixedVector>& positions, const std::vector<FixedBox>& boxes);
  ~Grid();

  /// Files `slot` under its position and box, wherever it was filed before.
  void file(Slot slot);
  /// Files `slot` again after a change of its position but not its box. It must be filed already.
  void refile(Slot slot) {
    refile(slot, m_levels[m_records[slot].level]);
    if (m_p_coverage != nullptr && m_records[slot].level > 0) cover(slot);
  }
  /// Removes `slot`, if it was filed.
  void remove(Slot slot);
  bool contains(Slot slot) const { return slot < m_records.size() && m_records[slot].level != kNotFiled; }
  int size() const;
  /// Counters of work done by the grid and its users.
  MoverStats& moverStats() { return m_mover_stats; }
  const MoverStats& moverStats() const { return m_mover_stats; }
  /// Returns the memory of the grid, in bytes.
  std::size_t bytes() const;

  static constexpr std::size_t kAll = ~std::size_t{0};
  /// Appends to `out` the slots whose boxes touch `box`, except `self`, in no particular order; a slot may
  /// appear twice. If more than `most` slots touch, appends only some of them, but more than `most`.
  void touching(const FixedBox& box, Slot self, std::vector<Slot>& out, std::size_t most = kAll) const;
  /// Calls `visit(slot)` for every slot of `level`, one of levels(), whose corner may lie in [from, to]. A
  /// slot may be visited twice. Stops when `visit` returns false.
  template <class Visit>
  void visitCorners(int level, FixedVector from, FixedVector to, Visit visit) const;
  /// Returns one bit per level, set if the level holds any box.
  std::uint32_t levels() const { return m_occupied; }
  /// Returns the size of the largest boxes that a level holds.
  static FixedVector largest(int level);

 private:
  class CoverageMask;
  static constexpr Slot kNone = 0x7FFFFFFF;
  static constexpr Slot kMore = 0x80000000;        // bit in a cell's first slot: the cell has more slots
  static constexpr Spot kSeveral = 0x8000;         // value of a cell's spot if it has several slots
  static constexpr std::size_t kRowOfSpots = 4;    // spots that are read at once; three are used
  static constexpr std::int64_t kBlock = 64;       // cells per side of a block
  static constexpr std::uint8_t kNotFiled = 0xff;  // value of Record::level
  static constexpr std::size_t kMinWords = 256;    // number of words of a level when it gets its first box
  static constexpr std::size_t kBoxesPerWord = 2;  // maximum number of boxes per word, averaged over a level

  struct Record {
    std::uint32_t cell = 0;
    Slot next = kNone;
    Slot previous = kNone;
    std::uint8_t level = kNotFiled;
    bool character = false;
    std::uint16_t area = 0;  // above level 0: cells that its cover takes; 0: too large for a cover
  };

  struct Level {
    int x_shift = kFixedBits;
    int y_shift = kFixedBits;
    std::int64_t base_x = 0;  // first block of the part of the world that is mapped without a turn
    std::int64_t base_y = 0;
    int x_bits = 0;  // log2 of the number of blocks in one turn of the torus
    int y_bits = 0;
    std::int64_t x_mask = 0;
    std::uint32_t word_mask = 0;
    int count = 0;
    std::vector<std::uint64_t> words;  // a bit per cell, set if it is occupied
    std::unique_ptr<Slot[]> heads;     // first slot of each occupied cell; other entries are undefined
    std::unique_ptr<Spot[]> spots;     // spot of each occupied cell of level 0; null: no spots

    std::uint32_t wordOf(std::int64_t x, std::int64_t y) const;
    std::uint32_t cellOf(FixedVector anchor) const;
    void shape(std::size_t word_count, std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1);
  };

  /// Returns a position's place within its cell, floored: x in the lowest eight bits, y in the next seven.
  static Spot spotOf(FixedVector p) {
    return static_cast<Spot>((p.x >> (kFixedBits - 8) & 0xFF) | (p.y >> (kFixedBits - 7) & 0x7F) << 8);
  }

  int levelOf(const FixedBox& box) const;
  void count(const Record& record, int by);
  void drop(Slot slot);
  void chooseCharacterLevel();
  void updateCoverage();
  void rebuildCoverage(bool is_exact);
  void cover(Slot slot);
  void fileAt(Slot slot, int number);
  void refile(Slot slot, Level& level);
  void link(Slot slot, Level& level, std::uint32_t cell);
  void unlink(Slot slot, Level& level);
  void rebuild(int level, std::size_t word_count);
  /// Returns the point by which a box is filed: in level 0 the position, else the box's corner.
  FixedVector anchor(Slot slot, int level) const {
    return level == 0 ? m_positions[slot] : m_positions[slot] + m_boxes[slot].corner;
  }
  FixedBox worldBox(Slot slot) const { return translate(m_boxes[slot], m_positions[slot]); }

  const std::vector<FixedVector>& m_positions;
  const std::vector<FixedBox>& m_boxes;
  std::array<Level, kLevels> m_levels;
  std::vector<Record> m_records;
  std::uint32_t m_occupied = 0;
  int m_characters = 0;
  int m_small_boxes = 0;                       // boxes of level 1 that are not characters
  bool m_characters_apart = true;              // true: characters are in level 0; false: in level 1
  int m_boxes_beside = 0;                      // boxes of all levels but 0
  int m_large_boxes = 0;                       // boxes above level 0 that are too large for a cover
  std::int64_t m_covered_area = 0;             // cells that the covers of all boxes take in all
  std::unique_ptr<CoverageMask> m_p_coverage;  // null: there are no characters, or only characters
  MoverStats m_mover_stats;
  std::vector<Slot> m_found;  // slots that Steps has found, if they are many
};

// Returns the index of the word that holds cell (x,y) and the other 63 cells of its row in the block.
inline std::uint32_t Grid::Level::wordOf(std::int64_t x, std::int64_t y) const {
  const std::int64_t bx = (x >> 6) - base_x;
  const std::int64_t by = (y >> 6) - base_y;
  const auto flat = static_cast<std::uint32_t>(((by << x_bits | (bx & x_mask)) << 6) | (y & 63));
  const std::int64_t turn_x = bx >> x_bits;
  const std::int64_t turn_y = by >> y_bits;
  if ((turn_x | turn_y) == 0) return flat & word_mask;
  const std::uint64_t hash = static_cast<std::uint64_t>(turn_x) * 0x9E3779B97F4A7C15ull +
                             static_cast<std::uint64_t>(turn_y) * 0xD1B54A32D192ED03ull;
  return (flat + static_cast<std::uint32_t>(hash >> 32)) & word_mask;
}

inline std::uint32_t Grid::Level::cellOf(FixedVector anchor) const {
  const std::int64_t x = anchor.x >> x_shift;
  return wordOf(x, anchor.y >> y_shift) << 6 | static_cast<std::uint32_t>(x & 63);
}

inline void Grid::link(Slot slot, Level& level, std::uint32_t cell) {
  std::uint64_t& word = level.words[cell >> 6];
  const std::uint64_t bit = std::uint64_t{1} << (cell & 63);
  Slot& head = level.heads[cell];
  Record& record = m_records[slot];
  record.cell = cell;
  record.previous = kNone;
  if ((word & bit) == 0) {
    word |= bit;
    record.next = kNone;
    head = slot;
    if (level.spots != nullptr) level.spots[cell] = spotOf(m_positions[slot]);
    return;
  }
  record.next = head & ~kMore;
  m_records[record.next].previous = slot;
  head = slot | kMore;
  if (level.spots != nullptr) level.spots[cell] = kSeveral;
}

inline void Grid::unlink(Slot slot, Level& level) {
  const Record& record = m_records[slot];
  if (record.next == kNone && record.previous == kNone) {
    level.words[record.cell >> 6] &= ~(std::uint64_t{1} << (record.cell & 63));
    return;
  }
  if (record.next != kNone) m_records[record.next].previous = record.previous;
  if (record.previous != kNone) {
    m_records[record.previous].next = record.next;
  } else {
    level.heads[record.cell] = record.next | kMore;
  }
  const Slot head = level.heads[record.cell] & ~kMore;
  if (m_records[head].next != kNone) return;
  level.heads[record.cell] = head;
  if (level.spots != nullptr) level.spots[record.cell] = spotOf(m_positions[head]);
}

inline void Grid::refile(Slot slot, Level& level) {
  const Record& record = m_records[slot];
  const std::uint32_t cell = level.cellOf(anchor(slot, record.level));
  if (cell == record.cell) {
    const bool alone = (record.next & record.previous) == kNone;
    if (alone && level.spots != nullptr) level.spots[cell] = spotOf(m_positions[slot]);
    return;
  }
  unlink(slot, level);
  link(slot, level, cell);
}

template <class Visit>
void Grid::visitCorners(int number, FixedVector from, FixedVector to, Visit visit) const {
  const Level& level = m_levels[static_cast<std::size_t>(number)];
  const auto proceed = [&](Slot s) {
    if constexpr (std::is_void_v<decltype(visit(s))>) {
      visit(s);
      return true;
    } else {
      return visit(s);
    }
  };
  const auto visitWord = [&](std::uint32_t index, std::uint64_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
      const Slot head = level.heads[index << 6 | bit];
      if (!proceed(head & ~kMore)) return false;
      if ((head & kMore) == 0) continue;
      for (Slot s = m_records[head & ~kMore].next; s != kNone; s = m_records[s].next) {
        if (!proceed(s)) return false;
      }
    }
    return true;
  };
  if (number == 0) {
    from = from - kCharacterBox.corner;
    to = to - kCharacterBox.corner;
  }
  const std::int64_t x0 = from.x >> level.x_shift;
  const std::int64_t y0 = from.y >> level.y_shift;
  const std::int64_t x1 = to.x >> level.x_shift;
  const std::int64_t y1 = to.y >> level.y_shift;
  const std::int64_t strips = (x1 >> 6) - (x0 >> 6) + 1;
  if (strips * (y1 - y0 + 1) > static_cast<std::int64_t>(level.words.size())) {
    for (std::uint32_t index = 0; index < level.words.size(); ++index) {
      if (!visitWord(index, level.words[index])) return;
    }
    return;
  }
  for (std::int64_t strip = x0 >> 6; strip <= x1 >> 6; ++strip) {
    std::uint64_t mask = ~std::uint64_t{0};
    if (strip == x0 >> 6) mask &= ~std::uint64_t{0} << (x0 & 63);
    if (strip == x1 >> 6) mask &= ~std::uint64_t{0} >> (63 - (x1 & 63));
    std::uint32_t index = level.wordOf(strip * kBlock, y0);
    for (std::int64_t y = y0;;) {
      const std::uint64_t bits = level.words[index] & mask;
      if (bits != 0 && !visitWord(index, bits)) return;
      if (++y > y1) break;
      index = (y & 63) == 0 ? level.wordOf(strip * kBlock, y) : (index + 1) & level.word_mask;
    }
  }
}

}  // namespace df
