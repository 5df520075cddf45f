// Finds room for a box: the nearest whole number of cells by which to move it so that it touches no other.
//
// A square of such offsets is a table with a bit for each; every solid Object in reach takes a rectangle of
// them. The squares double until the nearest free offset is nearer than anything outside.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/world/WorldStore.h"
#include "shared/values/Fixed.h"

namespace df {

class FreeRoom {
 public:
  /// Largest offset on each axis, in cells.
  static constexpr std::int64_t kReach = 1000;

  /// Room for `box`, in world coordinates, inside `boundary`.
  FreeRoom(const WorldStore& store, const FixedBox& boundary, const FixedBox& box)
      : m_store(store), m_boundary(boundary), m_box(box) {}

  /// The least (distance, y, x) in cells at which the box touches no solid Object and lies in the boundary.
  std::optional<FixedVector> nearest();

 private:
  // Offsets on one axis, in cells; empty if first > last.
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
  Range m_xs{0, -1};  // what the table covers
  Range m_ys{0, -1};
  std::int64_t m_words = 0;           // per row
  std::vector<std::uint64_t> m_free;  // row by row, offset x in bit x - m_xs.first
  std::vector<WorldStore::Slot> m_near;
};

}  // namespace df
