// A grid of coloured characters: what a view looks like. The server's display, the client's screen and
// the truth file all draw into this one type.
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

  /// Blanks look alike whatever their colour.
  friend bool operator==(const Cell& a, const Cell& b) {
    return a.ch == b.ch && (a.ch == U' ' || a.color == b.color);
  }
};

class Canvas {
 public:
  Canvas() = default;
  /// A blank canvas, `width` by `height` cells (both >= 0).
  Canvas(int width, int height);

  /// Size in cells.
  int width() const { return m_width; }
  int height() const { return m_height; }
  /// All cells blank.
  void clear();
  /// Put a character; outside the canvas it is dropped.
  void put(int x, int y, Cell cell);
  /// The cell at (x, y); blank outside the canvas.
  Cell at(int x, int y) const;
  /// Row `y` as UTF-8, without colours.
  std::string rowText(int y) const;
  /// All rows, each followed by a newline, trailing blanks of a row removed.
  std::string text() const;

  /// Cells that differ; canvases of different size differ in every cell of the larger area.
  friend int countDifferences(const Canvas& a, const Canvas& b);

 private:
  int m_width = 0;
  int m_height = 0;
  std::vector<Cell> m_cells;
};

/// Append the UTF-8 form of `ch` to `out`.
void appendUtf8(std::string& out, char32_t ch);

/// Decode UTF-8; a malformed byte becomes U+FFFD.
std::u32string decodeUtf8(const std::string& text);

/// May this character be drawn in one cell? Printable, one column wide, no control, bidi or zero-width
/// character. Everything that reaches a terminal passes this test.
bool isDrawable(char32_t ch);

}  // namespace df
