// What the terminal is to show, cell by cell, before ncurses makes escape sequences of the difference.
//
// Composing a picture needs no terminal, so the layout can be tested; Screen shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shared/replica/Look.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// How a cell is drawn beside its colour. Terminals without colours still have these.
enum class Style : unsigned char { kPlain, kBold, kReverse };

struct PictureCell {
  char32_t ch = U' ';
  df::Color color = df::COLOR_DEFAULT;
  Style style = Style::kPlain;
  df::Color background = df::BLACK;  ///< black: the terminal's own
  friend bool operator==(const PictureCell&, const PictureCell&) = default;
};

class Picture {
 public:
  Picture() = default;
  /// Blank, `width` by `height` cells.
  Picture(int width, int height);

  int width() const { return m_width; }
  int height() const { return m_height; }
  /// Outside the picture it is dropped. All cells with a background must have the same.
  void put(int x, int y, PictureCell cell);
  /// Blank outside the picture.
  PictureCell at(int x, int y) const;
  /// Write a safe text from (x, y) to the right, at most `columns` characters. Returns the column after it.
  int write(int x, int y, const std::string& text, int columns, df::Color color = df::COLOR_DEFAULT,
            Style style = Style::kPlain);
  /// Fill a rectangle with blanks.
  void fill(int x, int y, int width, int height, Style style = Style::kPlain);
  /// Draw a thin frame whose corners are (x, y) and (x + width - 1, y + height - 1).
  void frame(int x, int y, int width, int height);
  /// The one background of its cells that is not the terminal's own; black: there is none.
  df::Color background() const { return m_background; }
  /// Row `y` as UTF-8, for tests.
  std::string rowText(int y) const;

  /// Where the terminal's cursor is shown; nowhere by default.
  std::optional<CellPosition> cursor;

 private:
  int m_width = 0;
  int m_height = 0;
  df::Color m_background = df::BLACK;
  std::vector<PictureCell> m_cells;
};

}  // namespace naiad
