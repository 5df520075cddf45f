// Tests whether a box shows in any view. This happens for every Object in every tick, at a cost that hardly
// grows with the number of views.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/values/Fixed.h"

namespace df {

/// A set of views of one size, at corners in whole cells.
class ViewCover {
 public:
  ViewCover(const std::vector<FixedVector>& corners, FixedVector size);

  /// True if the box intersects a view, edges included (intersects() in Fixed.h).
  bool intersectsAny(const FixedBox& box) const;

 private:
  /// Limit of views that are tested one by one.
  static constexpr std::size_t kFew = 8;
  /// Blocks of 8 by 4 cells that lie wholly in a view are marked, at most kMaxBlocks.
  static constexpr int kColumnShift = 3;
  static constexpr int kRowShift = 2;
  static constexpr std::int64_t kMaxBlocks = 1 << 16;

  /// A corner, and the cell that contains it in a grid with cells of the size of a view.
  struct Corner {
    std::int64_t row, column;
    FixedVector at;
  };

  void markBlocks();
  bool isMarked(FixedVector point) const;
  std::int64_t columnOf(Fixed x) const;
  std::int64_t rowOf(Fixed y) const;

  FixedVector m_size;
  std::vector<Corner> m_corners;  ///< sorted by row, column and position; unique
  std::int64_t m_left = 0;        ///< edges of the marked area, in blocks
  std::int64_t m_top = 0;
  std::int64_t m_columns = 0;
  std::int64_t m_rows = 0;
  std::vector<bool> m_marked;
};

}  // namespace df
