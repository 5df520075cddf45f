// The set characters of an Object: rows of bits for the precise collision test (docs/collisions.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Fixed.h"

namespace df {

class Mask {
 public:
  /// Largest width and height in characters.
  static constexpr int kMaxSide = 1024;

#if __cplusplus >= 201703L
  /// Makes a mask from one UTF-8 string per row; a character is set unless it is a blank or `hole`. Shorter
  /// rows are padded with holes. Nullopt if there is no row, no character, or a side is longer than kMaxSide.
  static std::optional<Mask> fromRows(const std::vector<std::string>& rows, char32_t hole = U' ');
#endif

  int width() const {
    return m_width;
  }
  int height() const {
    return m_height;
  }
  /// True if character (x,y) is set; false outside.
  bool isSet(int x, int y) const;

 private:
  friend bool shareCell(const Mask* p_a, const FixedBox& a, const Mask* p_b, const FixedBox& b);

  std::uint64_t bitsFrom(std::int64_t x, std::int64_t y) const;

  int m_width = 0;
  int m_height = 0;
  int m_words = 0;                    // words per row of m_bits
  std::vector<std::uint64_t> m_bits;  // row by row, character x of a row in bit x % 64 of word x / 64
};

/// A rectangle of cells; neither side is 0.
struct CellBox {
  std::int64_t x;
  std::int64_t y;
  std::int64_t width;
  std::int64_t height;
};

/// Returns the cells that an Object's mask covers, holes included. `box` is the Object's box in world
/// coordinates. Character (i,j) is drawn in cell (⌊corner.x⌋ + 1 + i, ⌊corner.y⌋ + 1 + j). If `p_mask` is
/// null, the mask is full: max(1, ⌈width⌉) by max(1, ⌈height⌉) characters.
CellBox drawnCells(const Mask* p_mask, const FixedBox& box);

/// True if two Objects share a drawn cell. Each has a mask, null for a full one, and its box in world
/// coordinates. The boxes themselves are not tested.
bool shareCell(const Mask* p_a, const FixedBox& a, const Mask* p_b, const FixedBox& b);

}  // namespace df
