// What an object looks like, as data: captured from draw() on the server, drawn by the client.
#pragma once

#include <cstdint>
#include <vector>

#include "Canvas.h"
#include "Fixed.h"

namespace naiad {

/// One character of an appearance, placed relative to the object's position in units of 1/256 cell (so a
/// sprite of even width, whose cells lie at half offsets, is drawn in the right cells wherever it goes).
struct Glyph {
  std::int32_t dx = 0;
  std::int32_t dy = 0;
  char32_t ch = U' ';
  df::Color color = df::COLOR_DEFAULT;

  friend bool operator==(const Glyph&, const Glyph&) = default;
};

inline constexpr int kGlyphUnitBits = 8;  ///< 2^8 glyph units are one cell
/// Farthest from its object that a glyph may be drawn, in glyph units (8192 cells).
inline constexpr std::int64_t kMaxGlyphOffset = std::int64_t{1} << (13 + kGlyphUnitBits);

/// The cell, in world cells, in which a glyph of an object at `position` is drawn.
struct CellPosition {
  std::int32_t x = 0;
  std::int32_t y = 0;
  friend bool operator==(CellPosition, CellPosition) = default;
};
CellPosition glyphCell(df::FixedVector position, const Glyph& glyph);

/// Everything one draw() put on the screen, in drawing order.
using Appearance = std::vector<Glyph>;

/// A sequence of appearances and a selector that both ends evaluate. Today every look is constant: a
/// sequence of at most one (empty draws nothing).
struct Look {
  std::vector<Appearance> sequence;
  std::int32_t altitude = 2;

  /// The appearance shown at `tick`; null if the look draws nothing.
  const Appearance* select(std::uint32_t tick) const;
  friend bool operator==(const Look&, const Look&) = default;
};

}  // namespace naiad
