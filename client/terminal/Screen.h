// Puts pictures on the terminal with ncurses, which sends only what changed.
//
// Only cells that differ from the last picture are passed to ncurses. ncurses compares again, but making its
// cells costs more than that: without the first comparison a frame takes 1.7 times the processor time at
// 80x24 and 2.7 times at 200x60, and up to 8 % more bytes. Whole rows at a time (mvadd_wchnstr): 1.4 and 2.4.
//
// ncurses is used for output alone: it never reads the keyboard and sets no signal handlers (the
// TerminalGuard's are there first). One Screen at a time; all calls on one thread.
#pragma once

#include <string>

#include "client/terminal/Picture.h"
#include "shared/values/Color.h"

namespace naiad {

class Screen {
 public:
  struct Options {
    std::string type;    ///< TerminalType::name
    bool ascii = false;  ///< use the ASCII glyph set even if the locale is UTF-8
    bool colors = true;  ///< false: NO_COLOR
  };

  struct Size {
    int columns;
    int rows;
  };
  /// Only this part of a larger terminal is drawn on: ncurses takes 100 bytes for each cell, and a visitor of
  /// a door chooses the size. A game's view is smaller (shared/replica/Limits.h).
  static constexpr Size kMaxSize{640, 256};
  /// The terminal's size, 1 to kMaxSize; of COLUMNS and LINES if the terminal has none, and 80 x 24 without.
  static Size terminalSize();

  /// Enters the alternate screen. Throws std::runtime_error, with a sentence for people, if the terminal
  /// cannot do this.
  explicit Screen(const Options& options);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  int columns() const { return m_columns; }
  int rows() const { return m_rows; }

  /// Show the picture.
  void show(const Picture& picture);
  /// Ring the terminal's bell.
  void ring();
  /// The terminal's size may have changed. True if it has.
  bool readSize();
  /// Redraw everything with the next show(): another program has written on the terminal.
  void redrawAll() { m_redraw = true; }
  /// Back to the normal screen, while suspended or at the end; show() enters the alternate one again.
  void end();

 private:
  void setBackground(df::Color background);
  void put(int x, int y, const PictureCell& cell);

  bool m_ascii;
  bool m_colors;
  bool m_redraw = true;
  bool m_ended = false;
  int m_columns = 0;
  int m_rows = 0;
  df::Color m_background = df::BLACK;  ///< of the pairs for the game's
  Picture m_shown;
};

}  // namespace naiad
