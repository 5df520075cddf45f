#include "OracleMask.h"

#include <algorithm>

namespace oracle {

namespace {

/// Returns the first cell that is drawn. By the engine's rounding, it is the one after the cell of the box's
/// corner.
std::int64_t firstCell(Fixed corner) {
  return (corner >> df::kFixedBits) + 1;
}

std::int64_t cellsOf(Fixed size) {
  return std::max<std::int64_t>(1, (size + df::kFixedOne - 1) >> df::kFixedBits);
}

std::int64_t width(const FixedBox& box, const Mask& mask) {
  if (mask.empty()) return cellsOf(box.size.x);
  std::size_t longest = 0;
  for (const std::string& row : mask) longest = std::max(longest, row.size());
  return static_cast<std::int64_t>(longest);
}

std::int64_t height(const FixedBox& box, const Mask& mask) {
  return mask.empty() ? cellsOf(box.size.y) : static_cast<std::int64_t>(mask.size());
}

/// True if character (i,j), which must lie within the mask, is set.
bool isSet(const Mask& mask, std::int64_t i, std::int64_t j) {
  if (mask.empty()) return true;
  const std::string& row = mask[static_cast<std::size_t>(j)];
  return static_cast<std::size_t>(i) < row.size() && row[static_cast<std::size_t>(i)] != ' ';
}

}  // namespace

bool shareCell(const FixedBox& box_a, const Mask& mask_a, const FixedBox& box_b, const Mask& mask_b) {
  const std::int64_t ax = firstCell(box_a.corner.x);
  const std::int64_t ay = firstCell(box_a.corner.y);
  const std::int64_t bx = firstCell(box_b.corner.x);
  const std::int64_t by = firstCell(box_b.corner.y);
  const std::int64_t right = std::min(ax + width(box_a, mask_a), bx + width(box_b, mask_b));
  const std::int64_t bottom = std::min(ay + height(box_a, mask_a), by + height(box_b, mask_b));
  for (std::int64_t y = std::max(ay, by); y < bottom; ++y) {
    for (std::int64_t x = std::max(ax, bx); x < right; ++x) {
      if (isSet(mask_a, x - ax, y - ay) && isSet(mask_b, x - bx, y - by)) return true;
    }
  }
  return false;
}

}  // namespace oracle
