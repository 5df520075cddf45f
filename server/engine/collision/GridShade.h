// In which cells of level 0 a character may touch a box of another level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/collision/Grid.h"

namespace df {

/// A bit per cell of level 0: may a character there touch a box of another level? Where it may not, its move
/// needs no look at the other levels. The bits are exact only while such boxes cover few cells; otherwise
/// all are set, likewise while there is a large box. A box that moves costs the cells around it, a character
/// that moves one bit. Making one costs as much as the changes that it takes to need another.
class Grid::Shade {
 public:
  /// Cells of all boxes, for each character: with more it is not exact any more, with half as many it is
  /// again.
  static constexpr int kMostCellsPerCharacter = 8;
  static constexpr std::uint64_t kLargestArea = 4096;  ///< cells of one box

  /// How many cells a box of this size takes at most; 0: it is too large.
  static std::uint16_t areaOf(const FixedBox& box);
  /// No box is filed in it yet.
  Shade(const Level& level, bool is_exact);

  bool isExact() const { return m_is_exact; }
  /// Sets all bits for now, or no longer. What is filed stays known.
  void cover(bool is_covered);
  /// A box at its place, wherever it was before. Only of an exact one.
  void file(const Level& level, Slot slot, const FixedBox& world_box);
  void remove(const Level& level, Slot slot);
  /// As the words of the level.
  const std::uint64_t* words() const { return (m_are_set ? m_ones : m_words).data(); }
  std::size_t bytes() const {
    return (m_words.capacity() + m_ones.capacity()) * sizeof(m_words[0]) + m_counts.capacity() +
           m_areas.capacity() * sizeof(Area) + m_index.capacity() * sizeof(m_index[0]);
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
  std::size_t m_size;
  std::vector<std::uint64_t> m_words;  // empty, unless it is exact
  std::vector<std::uint64_t> m_ones;   // what counts while all are set; made when first needed
  bool m_are_set = false;
  std::vector<std::uint8_t> m_counts;  // by cell: of boxes; several may be near, or fall onto the same cells
  std::vector<Area> m_areas;
  std::vector<std::uint32_t> m_index;  // by slot: of its area
};

}  // namespace df
