// Buffer of the terminal's cells. Screen shows it with ncurses, which sends the differences.
//
// Composing a picture needs no terminal, so the layout can be tested.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shared/replica/Look.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// Style of a cell in addition to its colour. Terminals without colours show it as well.
enum class Style : unsigned char { kPlain, kBold, kReverse };

struct ScreenCell {
  char32_t ch = U' ';
  df::Color color = df::COLOR_DEFAULT;
  Style style = Style::kPlain;
  df::Color background = df::BLACK;  ///< black: the terminal's own background
  friend bool operator==(const ScreenCell&, const ScreenCell&) = default;
};

class ScreenBuffer {
 public:
  ScreenBuffer() = default;
  /// Makes a blank picture of `width` by `height` cells.
  ScreenBuffer(int width, int height);

  int width() const { return m_width; }
  int height() const { return m_height; }
  /// Sets a cell; ignored outside the picture. All cells that have a background must have equal backgrounds.
  void put(int x, int y, ScreenCell cell);
  /// Returns a cell; a blank one outside the picture.
  ScreenCell at(int x, int y) const;
  /// Writes a safe text (SafeText.h) at (x, y), at most `columns` characters. Returns the column after it.
  int write(int x, int y, const std::string& text, int columns, df::Color color = df::COLOR_DEFAULT,
            Style style = Style::kPlain);
  /// Fills a rectangle with blanks.
  void fill(int x, int y, int width, int height, Style style = Style::kPlain);
  /// Draws a thin frame with the corners (x, y) and (x + width - 1, y + height - 1).
  void frame(int x, int y, int width, int height);
  /// Returns the background of the cells that have one; black if none has.
  df::Color background() const { return m_background; }
  /// Returns row `y` as UTF-8, for tests.
  std::string rowText(int y) const;

  /// Position of the terminal's cursor; nullopt: hidden.
  std::optional<CellPosition> cursor;

 private:
  int m_width = 0;
  int m_height = 0;
  df::Color m_background = df::BLACK;
  std::vector<ScreenCell> m_cells;
};

}  // namespace naiad
