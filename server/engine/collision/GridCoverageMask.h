// Marks the cells of level 0 in which a character may touch a box of another level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/collision/Grid.h"

namespace df {

/// A bit per cell of level 0, set if a character there may touch a box of another level. If it is clear, a
/// move to this cell need not search the other levels. The bits are exact only while such boxes cover few
/// cells; otherwise, and while there is a large box, all count as set. Moving a box costs time per cell,
/// moving a character one bit test. Making a cover costs about as much as the changes that make it necessary.
class Grid::CoverageMask {
 public:
  /// If all boxes of other levels together take more than this many cells per character, the cover is no
  /// longer exact. At half as many cells it becomes exact again.
  static constexpr int kMaxCellsPerCharacter = 8;
  static constexpr std::uint64_t kMaxArea = 4096;  ///< limit of cells per box; a larger box sets all bits

  /// Returns the maximum number of cells that a box of this size takes; 0 if that is above kMaxArea.
  static std::uint16_t areaOf(const FixedBox& box);
  /// Makes a cover without boxes.
  CoverageMask(const Level& level, bool is_exact);

  bool isExact() const { return m_is_exact; }
  /// Sets whether all bits count as set. Keeps the filed boxes.
  void cover(bool is_covered);
  /// Files the slot's box at `world_box`, no longer where it was filed before. The cover must be exact.
  void file(const Level& level, Slot slot, const FixedBox& world_box);
  void remove(const Level& level, Slot slot);
  /// Returns the bits, arranged like the words of the level.
  const std::uint64_t* words() const { return (m_are_set ? m_ones : m_words).data(); }
  std::size_t bytes() const {
    return (m_words.capacity() + m_ones.capacity()) * sizeof(m_words[0]) + m_counts.capacity() +
           m_areas.capacity() * sizeof(Area) + m_index.capacity() * sizeof(m_index[0]);
  }

 private:
  static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint8_t kMaxCount = 255;  // a count that reaches this never changes again
  struct Area {
    Slot slot = 0;
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    friend constexpr bool operator==(const Area& a, const Area& b) = default;
  };
  void count(const Level& level, const Area& area, bool is_more);

  bool m_is_exact;
  std::size_t m_size;
  std::vector<std::uint64_t> m_words;  // empty if not exact
  std::vector<std::uint64_t> m_ones;   // used while all bits count as set; made when first needed
  bool m_are_set = false;
  std::vector<std::uint8_t> m_counts;  // number of boxes near each cell, or a whole turn of the torus away
  std::vector<Area> m_areas;
  std::vector<std::uint32_t> m_index;  // index in m_areas, by slot
};

}  // namespace df
