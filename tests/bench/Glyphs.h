// A rectangle of cells, some of which have a character. Used as a reference for precise collisions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "Impact.h"
#include "shared/values/Fixed.h"
#include "shared/values/SplitMix64.h"

namespace bench {

class Glyphs {
 public:
  /// Returns a rectangle of 3×2 to 12×4 cells, each of which has a character with a probability of 55 %.
  static Glyphs random(naiad::SplitMix64& random);

  /// Returns the rows for Object::setMask().
  const std::vector<std::string>& rows() const { return m_rows; }
  int width() const { return static_cast<int>(m_rows.front().size()); }
  int height() const { return static_cast<int>(m_rows.size()); }
  bool isSet(std::int64_t x, std::int64_t y) const;

 private:
  std::vector<std::string> m_rows;
};

/// True if the two, with their boxes in world coordinates, share a drawn cell. Compares every character.
bool shareCell(const Glyphs& a, const df::FixedBox& a_box, const Glyphs& b, const df::FixedBox& b_box);

/// Returns when the moving glyphs first touch the obstacle's box and share a cell with it; nullopt if never,
/// or if they share a cell at the start. Checks each position at which this may begin.
std::optional<Fraction> firstShare(const Path& path, const Glyphs& own, const df::FixedBox& obstacle,
                                   const Glyphs& others);

}  // namespace bench
