// Characters of which some are set, kept as the plain rows that they are: what precise collisions are judged
// by.
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
  /// 3×2 to 12×4 characters, 55 % of them set, at random.
  static Glyphs random(naiad::SplitMix64& random);

  /// As for Object::setMask().
  const std::vector<std::string>& rows() const { return m_rows; }
  int width() const { return static_cast<int>(m_rows.front().size()); }
  int height() const { return static_cast<int>(m_rows.size()); }
  bool isSet(std::int64_t x, std::int64_t y) const;

 private:
  std::vector<std::string> m_rows;
};

/// Do two of them, each with its box in world coordinates, share a drawn cell? Every character is compared.
bool shareCell(const Glyphs& a, const df::FixedBox& a_box, const Glyphs& b, const df::FixedBox& b_box);

/// When a moving one first touches the other by the boxes and shares a cell with it; nothing if it does not.
/// Not for one with which it shares a cell at the start. Every position at which one of the two may begin is
/// looked at.
std::optional<Fraction> firstShare(const Path& path, const Glyphs& own, const df::FixedBox& obstacle,
                                   const Glyphs& others);

}  // namespace bench
