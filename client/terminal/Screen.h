// Shows pictures on the terminal with ncurses, which sends only the changes.
//
// Only cells that differ from the last picture are passed to ncurses. It compares again, but making its cells
// costs more: without the first comparison a frame takes 1.7 times the processor time at 80x24, 2.7 times at
// 200x60, and up to 8 % more bytes. With whole rows (mvadd_wchnstr), the factors are 1.4 and 2.4.
//
// ncurses is used only for output: it never reads the keyboard and sets no signal handlers (the
// TerminalGuard's are installed before). Only one Screen may exist at a time, used on one thread.
#pragma once

#include <string>

#include "client/terminal/ScreenBuffer.h"
#include "shared/values/Color.h"

namespace naiad {

class Screen {
 public:
  struct Options {
    std::string type;    ///< TerminalType::name
    bool ascii = false;  ///< use the ASCII glyph set even if the locale is UTF-8
    bool colors = true;  ///< false if NO_COLOR is set
  };

  struct Size {
    int columns;
    int rows;
  };
  /// Limit on the used part of the terminal: ncurses takes 100 bytes for each cell, and a visitor of a door
  /// chooses the size. A game's view is smaller (shared/replica/Limits.h).
  static constexpr Size kMaxSize{640, 256};
  /// Returns the terminal's size, 1 to kMaxSize. If it reports none, returns COLUMNS and LINES, or 80 x 24.
  static Size terminalSize();

  /// Prepares ncurses for this terminal. Throws std::runtime_error with a sentence for people if it fails.
  explicit Screen(const Options& options);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  int columns() const { return m_columns; }
  int rows() const { return m_rows; }

  /// Shows the picture. Enters the alternate screen at the first call, and again after end().
  void show(const ScreenBuffer& picture);
  void ring();
  /// Reads the terminal's size. Returns true if it has changed.
  bool readSize();
  /// Makes the next show() redraw everything, because another program has written on the terminal.
  void redrawAll() { m_redraw = true; }
  /// Returns to the normal screen, while suspended or at the end.
  void end();

 private:
  void setBackground(df::Color background);
  void put(int x, int y, const ScreenCell& cell);

  bool m_ascii;
  bool m_colors;
  bool m_redraw = true;
  bool m_ended = false;
  int m_columns = 0;
  int m_rows = 0;
  df::Color m_background = df::BLACK;  ///< background of colour pairs 9 to 16
  ScreenBuffer m_shown;
};

}  // namespace naiad
