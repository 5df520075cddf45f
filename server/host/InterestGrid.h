// Where the published objects are, coarsely: who could be seen in a rectangle of cells?
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "Look.h"

namespace naiad {

/// Cells left … right − 1, top … bottom − 1.
struct CellRect {
  std::int64_t left = 0;
  std::int64_t top = 0;
  std::int64_t right = 0;
  std::int64_t bottom = 0;

  bool contains(CellPosition cell) const {
    return cell.x >= left && cell.x < right && cell.y >= top && cell.y < bottom;
  }
  CellRect grownBy(std::int64_t cells) const {
    return {left - cells, top - cells, right + cells, bottom + cells};
  }
};

/// Slots filed by their cell, in blocks of 16 by 8 cells. Memory follows the number of slots.
class InterestGrid {
 public:
  /// File `slot` where it is now; cheap if it has not left its block.
  void put(std::uint32_t slot, CellPosition cell);
  void remove(std::uint32_t slot);

  /// Call `visit(slot)` for every slot in a block that meets `rect`, unless the block lies in `inner`: all in
  /// the rectangle that are not in the inner one, and some more.
  template <class Visit>
  void forEachNear(const CellRect& rect, const CellRect& inner, Visit visit) const {
    const std::int64_t left = rect.left >> kColumnShift;
    const std::int64_t right = rect.right >> kColumnShift;
    const std::int64_t top = rect.top >> kRowShift;
    const std::int64_t bottom = rect.bottom >> kRowShift;
    const auto isInner = [&inner](std::int64_t x, std::int64_t y) {
      return x << kColumnShift >= inner.left && (x + 1) << kColumnShift <= inner.right &&
             y << kRowShift >= inner.top && (y + 1) << kRowShift <= inner.bottom;
    };
    const auto visitAll = [&visit](const std::vector<std::uint32_t>& block) {
      for (const std::uint32_t slot : block) visit(slot);
    };
    // A rectangle of more blocks than there are is answered by all of them.
    if (static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1) >=
        m_blocks.size()) {
      for (const auto& [key, block] : m_blocks) {
        const auto x = static_cast<std::int32_t>(key >> 32);
        const auto y = static_cast<std::int32_t>(key & 0xFFFFFFFF);
        if (x >= left && x <= right && y >= top && y <= bottom && !isInner(x, y)) visitAll(block);
      }
      return;
    }
    for (std::int64_t y = top; y <= bottom; ++y) {
      for (std::int64_t x = left; x <= right; ++x) {
        if (isInner(x, y)) continue;
        const auto found = m_blocks.find(keyOf(x, y));
        if (found != m_blocks.end()) visitAll(found->second);
      }
    }
  }

 private:
  static constexpr int kColumnShift = 4;
  static constexpr int kRowShift = 3;
  struct Place {
    std::uint64_t key = 0;
    std::uint32_t index = 0;  ///< in the block
    bool filed = false;
  };

  static std::uint64_t keyOf(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) | (static_cast<std::uint64_t>(y) & 0xFFFFFFFF);
  }

  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> m_blocks;
  std::vector<Place> m_places;  ///< by slot
};

}  // namespace naiad
