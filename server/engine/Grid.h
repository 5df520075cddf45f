// Finds the solid boxes near a box: a hierarchy of uniform grids, hashed.
//
// A box is filed once, under the grid cell of its corner, in the level whose cell size is the least power
// of two (from 2 cells up) that is not smaller than the box. So a query at one level looks at the cells it
// covers and one more to the left and above, and neither huge boxes nor far-flung worlds cost memory: a
// bucket array about as long as there are boxes, plus a fixed record per slot. Boxes in a bucket are
// chained through those records; nothing is allocated when something moves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "Fixed.h"

namespace df {

class Grid {
 public:
  using Slot = std::uint32_t;

  /// File `box` (world coordinates) under `slot`, in place of what was filed there before.
  void put(Slot slot, const FixedBox& box);
  /// Forget `slot`, if it was filed.
  void remove(Slot slot);
  bool contains(Slot slot) const { return slot < m_records.size() && m_records[slot].level >= 0; }
  int size() const { return m_count; }

  /// Append to `out`, in no particular order and each once, every slot whose box may touch `box`: all that
  /// do, and some that do not.
  void query(const FixedBox& box, std::vector<Slot>& out) const;

 private:
  static constexpr int kLevels = 21;  // up to 2^21 cells: boxes are at most 1e6 cells wide
  static constexpr Slot kNone = UINT32_MAX;

  /// A cell of one level.
  struct Place {
    std::int32_t level = -1;
    std::int32_t x = 0;
    std::int32_t y = 0;
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Record {
    std::int32_t level = -1;  // not filed
    std::int32_t x = 0;
    std::int32_t y = 0;
    Slot previous = kNone;
    Slot next = kNone;
  };

  static Place placeOf(const FixedBox& box);
  std::size_t bucketOf(Place place) const;
  void link(Slot slot);
  void unlink(Slot slot);
  void grow();
  void scan(std::uint32_t levels, std::vector<Slot>& out) const;

  std::vector<Slot> m_buckets;  // first slot of each chain; a power of two of them
  std::vector<Record> m_records;
  std::array<int, kLevels> m_level_counts{};
  std::uint32_t m_levels = 0;  // bit per level that has boxes
  int m_count = 0;
};

}  // namespace df
