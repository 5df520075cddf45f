// The content of an 80×24 screen: characters and their colours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bench::path {

inline constexpr int kWidth = 80;   ///< in cells
inline constexpr int kHeight = 24;  ///< in cells

/// A character in one of the terminal's eight colours, 1 (red) to 7 (white). Blanks have colour 0.
struct Cell {
  char ch = ' ';
  std::uint8_t color = 0;
  bool operator==(const Cell&) const = default;
};

/// A screen. Trivially copyable, so that it can be in shared memory.
struct Picture {
  std::array<Cell, static_cast<std::size_t>(kWidth) * kHeight> cells;

  Cell& at(int x, int y) { return cells[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]; }
  const Cell& at(int x, int y) const {
    return cells[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
  }
};

}  // namespace bench::path
