// Which cells of level 0 a character may not enter without touching a box of another level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/collision/Grid.h"

namespace df {

/// A bit per cell of level 0: may a character there touch a box of another level? Where it may not, its move
/// needs no look at the other levels. The bits are exact only while such boxes are few and small; otherwise
/// all are set. A box that moves costs the cells around it, a character that moves one bit.
class Grid::Shade {
 public:
  /// So many boxes at most for a number of characters; with fewer than half as many it begins to be exact.
  static constexpr int kCharactersPerBox = 8;
  static constexpr std::size_t kLargestArea = 4096;  ///< cells of one box

  /// Is the box too large for it?
  static bool isTooLarge(const FixedBox& box);
  /// No box is filed in it yet.
  Shade(const Level& level, bool is_exact);

  bool isExact() const { return m_is_exact; }
  /// A box at its place, wherever it was before. Only of an exact one; likewise remove().
  void file(const Level& level, Slot slot, const FixedBox& world_box);
  void remove(const Level& level, Slot slot);
  /// As the words of the level.
  const std::uint64_t* words() const { return m_words.data(); }
  std::size_t bytes() const {
    return m_words.capacity() * sizeof(m_words[0]) + m_counts.capacity() + m_areas.capacity() * sizeof(Area) +
           m_index.capacity() * sizeof(m_index[0]);
  }

 private:
  static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint8_t kMost = 255;  // stays: so many in one cell are never counted back
  struct Area {
    Slot slot = 0;
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    friend constexpr bool operator==(const Area& a, const Area& b) = default;
  };
  void count(const Level& level, const Area& area, bool is_more);

  bool m_is_exact;
  std::vector<std::uint64_t> m_words;
  std::vector<std::uint8_t> m_counts;  // by cell: of boxes; several may be near, or fall onto the same cells
  std::vector<Area> m_areas;
  std::vector<std::uint32_t> m_index;  // by slot: of its area
};

}  // namespace df
