// The straight path of a move, with the box that moves along it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/collision/Sweep.h"
#include "shared/values/Fixed.h"

namespace df {

class SweepPath {
 public:
  /// Range of the corner of the mover's box, both ends included.
  struct Piece {
    FixedVector low;
    FixedVector high;
  };

  /// See the constructor of Sweep.
  SweepPath(const FixedBox& box, FixedVector from, FixedVector to)
      : m_sweep(box, from, to), m_box(box), m_from(from), m_to(to) {}

  const Sweep& sweep() const { return m_sweep; }
  const FixedBox& box() const { return m_box; }
  FixedVector from() const { return m_from; }
  FixedVector to() const { return m_to; }
  /// Returns |to − from| on each axis, which may be more than a signed number holds.
  std::uint64_t lengthX() const { return distance(m_from.x, m_to.x); }
  std::uint64_t lengthY() const { return distance(m_from.y, m_to.y); }
  /// Returns the whole path.
  Piece whole() const {
    const auto [least_x, most_x] = std::minmax(m_from.x, m_to.x);
    const auto [least_y, most_y] = std::minmax(m_from.y, m_to.y);
    return {m_box.corner + FixedVector{least_x, least_y}, m_box.corner + FixedVector{most_x, most_y}};
  }

 private:
  static std::uint64_t distance(Fixed a, Fixed b) {
    const auto [least, most] = std::minmax(a, b);
    return static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least);
  }

  Sweep m_sweep;
  FixedBox m_box;
  FixedVector m_from;
  FixedVector m_to;
};

}  // namespace df
