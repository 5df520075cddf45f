// Tests whether a box intersects any view. This is done for every Object in every tick, at a cost that hardly
// grows with the number of views.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/values/Fixed.h"

namespace df {

/// A set of views of one size, each with its corner at a whole cell.
class ViewCover {
 public:
  ViewCover(const std::vector<FixedVector>& corners, FixedVector size);

  /// True if the box intersects a view, edges included (intersects() in Fixed.h).
  bool intersectsAny(const FixedBox& box) const;

 private:
  /// Up to this many views are tested one by one.
  static constexpr std::size_t kFew = 8;
  /// log2 of the size of a block: 8 by 4 cells. Blocks that lie wholly in a view are marked, unless the area
  /// of all views has more than kMaxBlocks blocks.
  static constexpr int kColumnShift = 3;
  static constexpr int kRowShift = 2;
  static constexpr std::int64_t kMaxBlocks = 1 << 16;

  /// The corner of a view, and the cell that contains it in a grid whose cells have the size of a view.
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
  std::int64_t m_left = 0;        ///< left edge of the area with marks, in blocks
  std::int64_t m_top = 0;
  std::int64_t m_columns = 0;
  std::int64_t m_rows = 0;
  std::vector<bool> m_marked;
};

}  // namespace df
