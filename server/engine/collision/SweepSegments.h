// A path cut into pieces, so that what lies along it is searched in the order of travel.
//
// It is as many steps long as its longer axis has units. Where the shorter axis is after so many steps is
// rounded, and a piece is a little wider for it: only the sweep says what is hit, and when.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/collision/SweepPath.h"

namespace df {

class SweepSegments {
 public:
  /// The path must not be of length 0.
  explicit SweepSegments(const SweepPath& path)
      : m_horizontal(path.lengthX() >= path.lengthY()),
        m_along(axis(path, m_horizontal)),
        m_across(axis(path, !m_horizontal)),
        m_slope(halfOf(m_across.length) / std::max(halfOf(m_along.length), 1.0)) {}

  /// Is the longer axis x?
  bool isHorizontal() const { return m_horizontal; }
  std::uint64_t length() const { return m_along.length; }
  /// How far the shorter axis goes at each step.
  double slope() const { return m_slope; }
  /// The time at which so many steps are done.
  Moment at(std::uint64_t steps) const { return {steps, m_along.length}; }
  /// Not more than the steps done at `moment`, and hardly less.
  std::uint64_t stepsBefore(Moment moment) const {
    if (moment.numerator == 0) return 0;
    constexpr double kLess = 1 - 1e-12;
    return static_cast<std::uint64_t>(moment.toDouble() * kLess * static_cast<double>(m_along.length));
  }
  /// From step `begin` to step `end`.
  SweepPath::Piece piece(std::uint64_t begin, std::uint64_t end) const {
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
    std::uint64_t length;
    std::uint64_t back;  // all ones if it goes back: arithmetic in place of an unpredictable branch

    Fixed after(std::uint64_t steps) const {
      return static_cast<Fixed>(static_cast<std::uint64_t>(start) + ((steps ^ back) - back));
    }
  };

  static Axis axis(const SweepPath& path, bool is_x) {
    const FixedVector corner = path.box().corner + path.from();
    if (is_x) return {corner.x, path.lengthX(), path.to().x < path.from().x ? ~std::uint64_t{0} : 0};
    return {corner.y, path.lengthY(), path.to().y < path.from().y ? ~std::uint64_t{0} : 0};
  }
  // Signed numbers become doubles faster.
  static double halfOf(std::uint64_t steps) {
    return static_cast<double>(static_cast<std::int64_t>(steps >> 1));
  }
  // Where the shorter axis is by then, or beyond.
  std::uint64_t across(std::uint64_t steps, double slack) const {
    const double half = m_slope * halfOf(steps) + slack;
    if (half <= 0) return 0;
    if (half >= halfOf(m_across.length)) return m_across.length;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(half)) * 2;
  }

  bool m_horizontal;
  Axis m_along;   // the longer one
  Axis m_across;  // the shorter one
  double m_slope;
};

}  // namespace df
