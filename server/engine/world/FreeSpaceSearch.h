// Finds the nearest free position for a box: the smallest move by whole cells that lets it touch nothing.
//
// The offsets form a square, a table with one bit for each. Every solid Object nearby rules out a rectangle
// of offsets. The square doubles until the nearest free offset is nearer than any outside it, or until the
// square has its maximum size.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/world/WorldStore.h"
#include "shared/values/Fixed.h"

namespace df {

class FreeSpaceSearch {
 public:
  /// Largest offset on each axis, in cells.
  static constexpr std::int64_t kReach = 1000;

  /// Prepares a search for `box`, in world coordinates, inside `boundary`.
  FreeSpaceSearch(const WorldStore& store, const FixedBox& boundary, const FixedBox& box)
      : m_store(store), m_boundary(boundary), m_box(box) {}

  /// Returns the least offset, by (distance, y, x), at which the box is inside the boundary and touches no
  /// solid Object; nullopt if not found.
  std::optional<FixedVector> nearest();

 private:
  // A range of offsets on one axis, in cells; empty if first > last.
  struct Range {
    std::int64_t first;
    std::int64_t last;

    Range within(const Range& other) const;
  };
  struct Offset {
    std::int64_t x;
    std::int64_t y;

    std::int64_t square() const { return x * x + y * y; }
  };

  static Range inside(Fixed low, Fixed size, Fixed boundary_low, Fixed boundary_size);
  static Range taken(Fixed low, Fixed size, Fixed other_low, Fixed other_size);
  void mark(const Range& xs, const Range& ys);
  void markTaken(const Range& xs, const Range& ys);
  std::optional<std::int64_t> nearestInRow(std::int64_t y) const;
  std::optional<Offset> nearestInTable() const;

  const WorldStore& m_store;
  const FixedBox m_boundary;
  const FixedBox m_box;
  Range m_xs{0, -1};  // offsets that the table covers
  Range m_ys{0, -1};
  std::int64_t m_words = 0;           // words per row
  std::vector<std::uint64_t> m_free;  // free offsets, row by row; x in bit x - m_xs.first
  std::vector<WorldStore::Slot> m_near;
};

}  // namespace df
