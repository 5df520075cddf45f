#include "client/terminal/ScreenBuffer.h"

#include <algorithm>

namespace naiad {

ScreenBuffer::ScreenBuffer(int width, int height)
    : m_width(std::max(width, 0)),
      m_height(std::max(height, 0)),
      m_cells(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height)) {}

void ScreenBuffer::put(int x, int y, ScreenCell cell) {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return;
  if (cell.background != df::BLACK) m_background = cell.background;
  m_cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x)] =
      cell;
}

ScreenCell ScreenBuffer::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return {};
  return m_cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
                 static_cast<std::size_t>(x)];
}

int ScreenBuffer::write(int x, int y, const std::string& text, int columns, df::Color color, Style style) {
  for (const char32_t ch : df::decodeUtf8(text)) {
    if (columns-- <= 0) break;
    put(x++, y, {ch, color, style});
  }
  return x;
}

void ScreenBuffer::fill(int x, int y, int width, int height, Style style) {
  for (int row = y; row < y + height; ++row) {
    for (int column = x; column < x + width; ++column) put(column, row, {U' ', df::COLOR_DEFAULT, style});
  }
}

void ScreenBuffer::frame(int x, int y, int width, int height) {
  const int right = x + width - 1;
  const int bottom = y + height - 1;
  for (int column = x + 1; column < right; ++column) {
    put(column, y, {U'─'});
    put(column, bottom, {U'─'});
  }
  for (int row = y + 1; row < bottom; ++row) {
    put(x, row, {U'│'});
    put(right, row, {U'│'});
  }
  put(x, y, {U'┌'});
  put(right, y, {U'┐'});
  put(x, bottom, {U'└'});
  put(right, bottom, {U'┘'});
}

std::string ScreenBuffer::rowText(int y) const {
  std::string text;
  for (int x = 0; x < m_width; ++x) df::appendUtf8(text, at(x, y).ch);
  return text;
}

}  // namespace naiad
