#include "engine/collision/Mask.h"

#include <algorithm>

#include "shared/values/Canvas.h"

namespace df {

namespace {

constexpr int kWordBits = 64;

std::int64_t charactersOf(Fixed size) {
  return std::max<std::int64_t>(1, (size + kFixedOne - 1) >> kFixedBits);
}

}  // namespace

std::optional<Mask> Mask::fromRows(const std::vector<std::string>& rows, char32_t hole) {
  if (rows.empty() || rows.size() > kMaxSide) return std::nullopt;
  std::vector<std::u32string> decoded;
  decoded.reserve(rows.size());
  std::size_t width = 0;
  for (const std::string& row : rows) {
    decoded.push_back(decodeUtf8(row));
    width = std::max(width, decoded.back().size());
  }
  if (width == 0 || width > kMaxSide) return std::nullopt;

  Mask mask;
  mask.m_width = static_cast<int>(width);
  mask.m_height = static_cast<int>(rows.size());
  mask.m_words = (mask.m_width + kWordBits - 1) / kWordBits;
  mask.m_bits.resize(rows.size() * static_cast<std::size_t>(mask.m_words));
  std::uint64_t* p_row = mask.m_bits.data();
  for (const std::u32string& row : decoded) {
    for (std::size_t x = 0; x < row.size(); ++x) {
      if (row[x] != U' ' && row[x] != hole) p_row[x / kWordBits] |= std::uint64_t{1} << (x % kWordBits);
    }
    p_row += mask.m_words;
  }
  return mask;
}

bool Mask::isSet(int x, int y) const {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return false;
  return (bitsFrom(x, y) & 1u) != 0;
}

// Returns characters x … x + 63 of row y, the first in the lowest bit. Characters beyond the row are holes.
std::uint64_t Mask::bitsFrom(std::int64_t x, std::int64_t y) const {
  const std::uint64_t* p_row = m_bits.data() + y * m_words;
  const auto word = static_cast<std::uint64_t>(x) / kWordBits;
  const auto bit = static_cast<std::uint64_t>(x) % kWordBits;
  std::uint64_t bits = p_row[word] >> bit;
  if (bit != 0 && word + 1 < static_cast<std::uint64_t>(m_words))
    bits |= p_row[word + 1] << (kWordBits - bit);
  return bits;
}

CellBox drawnCells(const Mask* p_mask, const FixedBox& box) {
  const std::int64_t x = (box.corner.x >> kFixedBits) + 1;
  const std::int64_t y = (box.corner.y >> kFixedBits) + 1;
  if (p_mask == nullptr) return {x, y, charactersOf(box.size.x), charactersOf(box.size.y)};
  return {x, y, p_mask->width(), p_mask->height()};
}

bool shareCell(const Mask* p_a, const FixedBox& a, const Mask* p_b, const FixedBox& b) {
  const CellBox in_a = drawnCells(p_a, a);
  const CellBox in_b = drawnCells(p_b, b);
  const std::int64_t x0 = std::max(in_a.x, in_b.x);
  const std::int64_t y0 = std::max(in_a.y, in_b.y);
  const std::int64_t x1 = std::min(in_a.x + in_a.width, in_b.x + in_b.width);
  const std::int64_t y1 = std::min(in_a.y + in_a.height, in_b.y + in_b.height);
  if (x0 >= x1 || y0 >= y1) return false;
  if (p_a == nullptr && p_b == nullptr) return true;

  for (std::int64_t y = y0; y < y1; ++y) {
    for (std::int64_t x = x0; x < x1; x += kWordBits) {
      std::uint64_t bits = ~std::uint64_t{0};
      if (x1 - x < kWordBits) bits >>= kWordBits - (x1 - x);  // a full mask ends here, too
      if (p_a != nullptr) bits &= p_a->bitsFrom(x - in_a.x, y - in_a.y);
      if (p_b != nullptr) bits &= p_b->bitsFrom(x - in_b.x, y - in_b.y);
      if (bits != 0) return true;
    }
  }
  return false;
}

}  // namespace df
