#include "client/terminal/Screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

// Needed for the wide-character functions of curses.h.
#ifndef NCURSES_WIDECHAR
#define NCURSES_WIDECHAR 1
#endif
#include <curses.h>
#include <langinfo.h>

#include "client/terminal/AsciiFallback.h"

namespace naiad {
namespace {

/// Returns the ncurses colour pair: 1 to 8 on the terminal's own background, 9 to 16 on the game's. (With
/// eight colours there are not enough pairs for all backgrounds at once, but a picture has only one.)
short pairOf(df::Color color, bool own_background) {
  return static_cast<short>(color + (own_background ? 1 : 1 + df::kColorCount));
}

/// True if numbers of colours are red, green and blue, 8 bits each, instead of places in a palette. Numbers
/// below 256 may still be places in a palette. All direct-color terminals of ncurses' database have 8 bits.
bool isDirect() {
  return COLORS == 1 << 24;
}

/// Returns the colour of a background.
int cursesColor(df::Color color) {
  static constexpr int kDirect[] = {0, 0x7A1414, 0x14602A, 0x6A6A14, 0x1A2F7A, 0x6A1A5A, 0x14606A, 0xB0B0B0};
  if (isDirect()) return kDirect[color];
  static constexpr int kColors[] = {COLOR_BLACK, COLOR_RED,     COLOR_GREEN, COLOR_YELLOW,
                                    COLOR_BLUE,  COLOR_MAGENTA, COLOR_CYAN,  COLOR_WHITE};
  return kColors[color];
}

/// Returns the colour of characters: bright, if the terminal has bright variants of the eight colours at 8
/// to 15.
int brightColor(df::Color color) {
  static constexpr int kDirect[] = {0x4D4D4D, 0xFF5555, 0x50FA7B, 0xF1FA8C,
                                    0x7AA2FF, 0xFF79C6, 0x8BE9FD, 0xE4E4E4};
  if (isDirect()) return kDirect[color];
  return cursesColor(color) + (COLORS >= 16 ? 8 : 0);
}

int numberOf(const char* variable, int otherwise) {
  const char* p_text = std::getenv(variable);
  const long number = p_text != nullptr ? std::strtol(p_text, nullptr, 10) : 0;
  return number > 0 ? static_cast<int>(std::min<long>(number, INT_MAX)) : otherwise;
}

}  // namespace

Screen::Size Screen::terminalSize() {
  winsize size{};
  const bool is_known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  return {std::min(is_known ? size.ws_col : numberOf("COLUMNS", 80), kMaxSize.columns),
          std::min(is_known ? size.ws_row : numberOf("LINES", 24), kMaxSize.rows)};
}

Screen::Screen(const Options& options) : m_ascii(options.ascii), m_colors(options.colors) {
  std::setlocale(LC_CTYPE, "");
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0) m_ascii = true;

  // newterm() allocates the size in these variables. Without them it uses the terminal's size, unlimited.
  const Size size = terminalSize();
  setenv("COLUMNS", std::to_string(size.columns).c_str(), 1);
  setenv("LINES", std::to_string(size.rows).c_str(), 1);
  if (newterm(const_cast<char*>(options.type.c_str()), stdout, stdin) == nullptr) {
    throw std::runtime_error("TERM=" + options.type + " is not a terminal that dfclient can draw on.");
  }
  curs_set(0);
  leaveok(stdscr, FALSE);
  scrollok(stdscr, FALSE);
  m_colors = m_colors && has_colors();
  if (m_colors) {
    start_color();
    // Use the terminal's own background where that is supported; black must differ from it.
    const bool has_default = use_default_colors() == OK;
    for (int c = df::BLACK; c < df::kColorCount; ++c) {
      const auto color = static_cast<df::Color>(c);
      // Dragonfly's colours are the bright ones. Black becomes bright black, visible on a black background.
      int foreground = brightColor(color);
      if (color == df::COLOR_DEFAULT && has_default) foreground = -1;
      if (color == df::BLACK && COLORS > 8 && COLORS < 16) foreground = 8;
      init_extended_pair(pairOf(color, true), foreground, has_default ? -1 : COLOR_BLACK);
    }
  }
  readSize();
}

Screen::~Screen() {
  end();
}

// Pairs on the game's background do not use the terminal's default colours, which differ between terminals.
void Screen::setBackground(df::Color background) {
  if (!m_colors || background == df::BLACK || background == m_background) return;
  m_background = background;
  for (int c = df::BLACK; c < df::kColorCount; ++c) {
    const auto color = static_cast<df::Color>(c);
    // Black stays black on a game's background.
    init_extended_pair(pairOf(color, false), color == df::BLACK ? COLOR_BLACK : brightColor(color),
                       cursesColor(background));
  }
  m_redraw = true;
}

bool Screen::readSize() {
  const Size size = terminalSize();
  if (size.rows != LINES || size.columns != COLS) resizeterm(size.rows, size.columns);
  if (m_columns == COLS && m_rows == LINES) return false;
  m_columns = COLS;
  m_rows = LINES;
  m_redraw = true;
  return true;
}

void Screen::show(const ScreenBuffer& picture) {
  setBackground(picture.background());
  const bool all =
      m_redraw || m_ended || picture.width() != m_shown.width() || picture.height() != m_shown.height();
  if (all) {
    clearok(stdscr, TRUE);
    erase();
  }
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const ScreenCell cell = picture.at(x, y);
      if (all || !(cell == m_shown.at(x, y))) put(x, y, cell);
    }
  }
  if (picture.cursor) move(picture.cursor->y, picture.cursor->x);
  curs_set(picture.cursor ? 1 : 0);
  refresh();
  m_shown = picture;
  m_redraw = false;
  m_ended = false;
}

void Screen::ring() {
  if (!m_ended) beep();
}

void Screen::put(int x, int y, const ScreenCell& cell) {
  attr_t attributes = A_NORMAL;
  // Terminals with only eight colours show bold ones brighter, so dark blue is drawn bold.
  const bool is_dark = m_colors && COLORS < 16 && cell.color == df::BLUE && cell.background == df::BLACK;
  if (cell.style == Style::kBold || is_dark) attributes |= A_BOLD;
  if (cell.style == Style::kReverse) attributes |= A_REVERSE;
  const short pair = m_colors ? pairOf(cell.color, cell.background == df::BLACK) : static_cast<short>(0);
  // Only one drawable character may reach the terminal, whatever is in the cell.
  const char32_t safe = df::isDrawable(cell.ch) ? cell.ch : U'?';
  const wchar_t text[2] = {m_ascii ? static_cast<wchar_t>(asciiFor(safe)) : static_cast<wchar_t>(safe),
                           L'\0'};
  cchar_t glyph;
  setcchar(&glyph, text, attributes, pair, nullptr);
  mvadd_wch(y, x, &glyph);
}

void Screen::end() {
  if (m_ended) return;
  m_ended = true;
  endwin();
}

}  // namespace naiad
