// The straight way of a move, cut into pieces, so that what lies along it is searched in the order of travel.
//
// A way is as many steps long as its longer axis has units; where the shorter axis is after so many steps is
// rounded here, and a piece is a little wider for it. Who is met, and when, only the sweep says.
#pragma once

#include <algorithm>
#include <cstdint>

#include "Fixed.h"
#include "Sweep.h"

namespace df {

class Way {
 public:
  /// What the corner of the mover's box passes over: both ends belong to it.
  struct Piece {
    FixedVector low;
    FixedVector high;
  };

  /// As for Sweep.
  Way(const FixedBox& box, FixedVector from, FixedVector to)
      : Way(box, from, to, Axis(box.corner.x, from.x, to.x), Axis(box.corner.y, from.y, to.y)) {}

  const Sweep& sweep() const { return m_sweep; }
  FixedVector from() const { return m_from; }
  FixedVector to() const { return m_to; }
  FixedVector boxSize() const { return m_size; }
  bool isHorizontal() const { return m_horizontal; }
  std::uint64_t length() const { return m_along.way; }
  /// How far the shorter axis goes for each step, 0 to 1.
  double slope() const { return m_slope; }
  /// The time at which so many steps are done. Not for a way without any.
  Moment at(std::uint64_t steps) const { return {steps, m_along.way}; }
  /// Not more than the steps done at `moment`, and hardly less.
  std::uint64_t stepsBefore(Moment moment) const {
    if (moment.numerator == 0) return 0;
    return static_cast<std::uint64_t>(moment.toDouble() * (1 - 1e-12) * static_cast<double>(m_along.way));
  }
  /// From step `begin` to step `end`.
  Piece piece(std::uint64_t begin, std::uint64_t end) const {
    const auto [along_low, along_high] = std::minmax({m_along.after(begin), m_along.after(end)});
    const auto [across_low, across_high] =
        std::minmax({m_across.after(across(begin, -kSlack)), m_across.after(across(end, kSlack))});
    if (m_horizontal) return {{along_low, across_low}, {along_high, across_high}};
    return {{across_low, along_low}, {across_high, along_high}};
  }

 private:
  // In units of two: doubles have 53 bits, steps 64; some thousand units are lost, this many are not.
  static constexpr double kSlack = 1 << 20;

  struct Axis {
    Fixed start;  // of the box's corner
    std::uint64_t way;
    bool back;

    Axis(Fixed corner, Fixed from, Fixed to)
        : start(corner + from),
          way(from < to ? static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from)
                        : static_cast<std::uint64_t>(from) - static_cast<std::uint64_t>(to)),
          back(to < from) {}
    Fixed after(std::uint64_t steps) const {
      const auto begin = static_cast<std::uint64_t>(start);
      return static_cast<Fixed>(back ? begin - steps : begin + steps);
    }
  };

  Way(const FixedBox& box, FixedVector from, FixedVector to, const Axis& x, const Axis& y)
      : m_sweep(box, from, to),
        m_from(from),
        m_to(to),
        m_size(box.size),
        m_horizontal(x.way >= y.way),
        m_along(m_horizontal ? x : y),
        m_across(m_horizontal ? y : x),
        m_slope(m_along.way <= 1 ? 1 : halfOf(m_across.way) / halfOf(m_along.way)) {}

  // Signed numbers become doubles faster.
  static double halfOf(std::uint64_t steps) {
    return static_cast<double>(static_cast<std::int64_t>(steps >> 1));
  }

  // Where the shorter axis is by then, or beyond.
  std::uint64_t across(std::uint64_t steps, double slack) const {
    const double half = m_slope * halfOf(steps) + slack;
    if (half <= 0) return 0;
    if (half >= halfOf(m_across.way)) return m_across.way;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(half)) * 2;
  }

  Sweep m_sweep;
  FixedVector m_from;
  FixedVector m_to;
  FixedVector m_size;
  bool m_horizontal;
  Axis m_along;   // the longer one
  Axis m_across;  // the shorter one
  double m_slope;
};

}  // namespace df
