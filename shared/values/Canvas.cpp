#include "shared/values/Canvas.h"

#include <algorithm>
#include <array>

namespace df {

Canvas::Canvas(int width, int height)
    : m_width(std::max(width, 0)),
      m_height(std::max(height, 0)),
      m_cells(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height)) {}

void Canvas::clear() {
  std::fill(m_cells.begin(), m_cells.end(), Cell{});
}

void Canvas::put(int x, int y, Cell cell) {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return;
  m_cells[static_cast<std::size_t>(y) * m_width + x] = cell;
}

Cell Canvas::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return {};
  return m_cells[static_cast<std::size_t>(y) * m_width + x];
}

std::string Canvas::rowText(int y) const {
  std::string row;
  for (int x = 0; x < m_width; ++x) appendUtf8(row, at(x, y).ch);
  return row;
}

std::string Canvas::text() const {
  std::string all;
  for (int y = 0; y < m_height; ++y) {
    std::string row = rowText(y);
    row.erase(row.find_last_not_of(' ') + 1);
    all += row + '\n';
  }
  return all;
}

int countDifferences(const Canvas& a, const Canvas& b) {
  const int width = std::max(a.m_width, b.m_width);
  const int height = std::max(a.m_height, b.m_height);
  if (a.m_width != b.m_width || a.m_height != b.m_height) return width * height;
  int differences = 0;
  for (std::size_t i = 0; i < a.m_cells.size(); ++i) differences += a.m_cells[i] == b.m_cells[i] ? 0 : 1;
  return differences;
}

void appendUtf8(std::string& out, char32_t ch) {
  const auto byte = [&out](char32_t b) { out.push_back(static_cast<char>(b)); };
  if (ch < 0x80) {
    byte(ch);
  } else if (ch < 0x800) {
    byte(0xC0 | (ch >> 6));
    byte(0x80 | (ch & 0x3F));
  } else if (ch < 0x10000) {
    byte(0xE0 | (ch >> 12));
    byte(0x80 | ((ch >> 6) & 0x3F));
    byte(0x80 | (ch & 0x3F));
  } else {
    byte(0xF0 | (ch >> 18));
    byte(0x80 | ((ch >> 12) & 0x3F));
    byte(0x80 | ((ch >> 6) & 0x3F));
    byte(0x80 | (ch & 0x3F));
  }
}

std::u32string decodeUtf8(const std::string& text) {
  constexpr char32_t kBad = 0xFFFD;
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int extra = lead < 0x80                   ? 0
                      : lead >= 0xF0 && lead < 0xF5 ? 3
                      : lead >= 0xE0 && lead < 0xF0 ? 2
                      : lead >= 0xC2 && lead < 0xE0 ? 1
                                                    : -1;
    if (extra < 0 || i + static_cast<std::size_t>(extra) >= text.size()) {
      out.push_back(kBad);
      ++i;
      continue;
    }
    char32_t ch = extra == 0 ? lead : lead & (0x3F >> extra);
    bool good = true;
    for (int k = 1; k <= extra; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      good = good && (next & 0xC0) == 0x80;
      ch = (ch << 6) | (next & 0x3F);
    }
    static constexpr std::array<char32_t, 4> kMin = {0, 0x80, 0x800, 0x10000};
    good = good && ch >= kMin[extra] && ch <= 0x10FFFF && (ch < 0xD800 || ch > 0xDFFF);
    out.push_back(good ? ch : kBad);
    i += good ? static_cast<std::size_t>(extra) + 1 : 1;
  }
  return out;
}

// A complete table of one-column ranges would be long. Games draw ASCII, Latin, Greek, Cyrillic, box drawing,
// blocks, arrows and a few symbols, so only those are allowed.
bool isDrawable(char32_t ch) {
  struct Range {
    char32_t first;
    char32_t last;
  };
  static constexpr std::array<Range, 9> kNarrow = {{{0x20, 0x7E},
                                                    {0xA0, 0xAC},        // Latin-1, without the soft hyphen
                                                    {0xAE, 0x2FF},       // up to the modifier letters
                                                    {0x370, 0x373},      // Greek
                                                    {0x384, 0x482},      // Greek, Cyrillic
                                                    {0x2010, 0x2027},    // dashes, quotes, dots
                                                    {0x2190, 0x22FF},    // arrows, mathematics
                                                    {0x2500, 0x25FC},    // box drawing, blocks, shapes
                                                    {0x2800, 0x28FF}}};  // Braille patterns
  return std::any_of(kNarrow.begin(), kNarrow.end(),
                     [ch](Range range) { return ch >= range.first && ch <= range.last; });
}

}  // namespace df
