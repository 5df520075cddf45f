// A coarse grid of the published objects, to find those that may be visible in a rectangle of cells.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shared/replica/Look.h"

namespace naiad {

/// A rectangle of cells: columns left … right − 1, rows top … bottom − 1.
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

/// A CellRect in half the memory, because thousands are compared. Coordinates that exceed the type are
/// clamped; no position is that far out.
struct CompactRect {
  CompactRect() = default;
  explicit CompactRect(const CellRect& rect)
      : left(clamped(rect.left)),
        top(clamped(rect.top)),
        right(clamped(rect.right)),
        bottom(clamped(rect.bottom)) {}
  static CompactRect everywhere() { return CompactRect({INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX}); }
  /// Returns a rectangle that overlaps no other.
  static CompactRect nowhere() { return CompactRect({INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN}); }
  bool meets(const CompactRect& other) const {
    // No branches, because they would be unpredictable.
    return static_cast<int>(left < other.right) & static_cast<int>(other.left < right) &
           static_cast<int>(top < other.bottom) & static_cast<int>(other.top < bottom);
  }

  std::int32_t left = 0;
  std::int32_t top = 0;
  std::int32_t right = 0;
  std::int32_t bottom = 0;

 private:
  static std::int32_t clamped(std::int64_t cell) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(cell, INT32_MIN, INT32_MAX));
  }
};

/// Slots grouped by position, in blocks of 16 by 8 cells. Memory is proportional to the number of slots.
class InterestGrid {
 public:
  /// Stores `slot` at the object's present cell. Cheap if the object has not left its block.
  void put(std::uint32_t slot, CellPosition cell) {
    if (slot >= m_entries.size()) m_entries.resize(std::size_t{slot} + 1);
    const std::uint64_t key = keyOf(cell.x >> kColumnShift, cell.y >> kRowShift);
    if (m_entries[slot].filed && m_entries[slot].key == key) return;
    remove(slot);
    Block& block = m_blocks[key];
    if (block.empty()) foundOf(key).valid = false;
    m_entries[slot] = {key, static_cast<std::uint32_t>(block.size()), true};
    block.push_back(slot);
  }
  void remove(std::uint32_t slot) {
    if (slot >= m_entries.size() || !m_entries[slot].filed) return;
    const BlockEntry place = m_entries[slot];
    const auto found = m_blocks.find(place.key);
    Block& block = found->second;
    block[place.index] = block.back();
    m_entries[block.back()].index = place.index;
    block.pop_back();
    if (block.empty()) {
      foundOf(place.key).valid = false;
      m_blocks.erase(found);
    }
    m_entries[slot].filed = false;
  }

  /// Calls `visit(slot)` for every slot in a block that overlaps `rect`, except blocks inside `inner`. So it
  /// visits all slots that are in `rect` but not in `inner`, and some other slots.
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
    // If the rectangle has more blocks than exist, go through the existing blocks instead.
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
        if (const std::vector<std::uint32_t>* block = find(keyOf(x, y))) visitAll(*block);
      }
    }
  }

 private:
  static constexpr int kColumnShift = 4;
  static constexpr int kRowShift = 3;
  struct BlockEntry {
    std::uint64_t key = 0;
    std::uint32_t index = 0;  ///< index in the block
    bool filed = false;
  };

  static std::uint64_t keyOf(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) | (static_cast<std::uint64_t>(y) & 0xFFFFFFFF);
  }

  using Block = std::vector<std::uint32_t>;
  /// A cache entry: the last result for the keys that map to it. `block` is null if there was no block.
  struct Found {
    std::uint64_t key = 0;
    const Block* block = nullptr;
    bool valid = false;
  };
  static constexpr std::size_t kFound = 1024;
  Found& foundOf(std::uint64_t key) const { return m_found[((key >> 32) & 31) | (key & 31) << 5]; }
  /// Returns the block; null if it is empty.
  const Block* find(std::uint64_t key) const {
    Found& found = foundOf(key);
    if (found.valid && found.key == key) return found.block;
    const auto place = m_blocks.find(key);
    found = {key, place != m_blocks.end() ? &place->second : nullptr, true};
    return found.block;
  }

  std::unordered_map<std::uint64_t, Block> m_blocks;
  mutable std::array<Found, kFound> m_found{};  ///< cache of find()
  std::vector<BlockEntry> m_entries;            ///< indexed by slot
};

}  // namespace naiad
