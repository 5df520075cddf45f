// A grid of coloured characters: a view's image in the server's display, the client's screen, the truth file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Color.h"

namespace df {

/// One character cell.
struct Cell {
  char32_t ch = U' ';
  Color color = COLOR_DEFAULT;

  /// Blanks are equal regardless of their colour.
  friend bool operator==(const Cell& a, const Cell& b) {
    return a.ch == b.ch && (a.ch == U' ' || a.color == b.color);
  }
};

class Canvas {
 public:
  Canvas() = default;
  /// Makes a blank canvas of `width` by `height` cells (both >= 0).
  Canvas(int width, int height);

  /// Size in cells.
  int width() const { return m_width; }
  int height() const { return m_height; }
  /// Makes all cells blank.
  void clear();
  /// Sets a cell; ignored outside the canvas.
  void put(int x, int y, Cell cell);
  /// Returns the cell at (x, y); blank outside the canvas.
  Cell at(int x, int y) const;
  /// Returns row `y` as UTF-8, without colours.
  std::string rowText(int y) const;
  /// Returns all rows, each followed by a newline, without trailing blanks.
  std::string text() const;

  /// Returns the number of different cells; if the sizes differ, the larger width times the larger height.
  friend int countDifferences(const Canvas& a, const Canvas& b);

 private:
  int m_width = 0;
  int m_height = 0;
  std::vector<Cell> m_cells;
};

/// Appends the UTF-8 form of `ch` to `out`.
void appendUtf8(std::string& out, char32_t ch);

/// Decodes UTF-8; malformed bytes become U+FFFD.
std::u32string decodeUtf8(const std::string& text);

/// True if the character is in one of the ranges that may be drawn. They have only printable characters, one
/// column wide: no control, bidi or zero-width characters. All characters sent to a terminal pass this test.
bool isDrawable(char32_t ch);

}  // namespace df
