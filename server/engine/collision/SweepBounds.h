// A quick bound, in doubles, on when a move touches a box: without a branch, from a little too early to a
// little too late. Sweep tests what this leaves exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/collision/SweepPath.h"
#include "shared/values/Fixed.h"

namespace df {

class SweepBounds {
 public:
  /// Times of the move at which a box is touched, also before its start and after its end; enter > leave if
  /// it never is.
  struct Stay {
    double enter;
    double leave;
  };

  explicit SweepBounds(const SweepPath& path)
      : m_x(path.box().corner.x + path.from().x, path.box().size.x, path.lengthX(),
            path.to().x < path.from().x),
        m_y(path.box().corner.y + path.from().y, path.box().size.y, path.lengthY(),
            path.to().y < path.from().y) {}

  Stay at(const FixedBox& other) const {
    const Stay x = m_x.at(other.corner.x, other.size.x);
    const Stay y = m_y.at(other.corner.y, other.size.y);
    return {std::max(x.enter, y.enter), std::min(x.leave, y.leave)};
  }
  /// No hit at or before `moment` has a later enter.
  static double latest(Moment moment) { return moment.toDouble() * (1 + 1e-12); }

 private:
  // On this side and that, in units: doubles of coordinates are some thousand off.
  static constexpr double kSlack = 1 << 16;
  // For an axis at rest, where each unit is worth for ever.
  static constexpr double kForEver = 1e100;

  struct Axis {
    double centre;
    double half;      // of its size
    double per_unit;  // time, negative if it goes back

    Axis(Fixed corner, Fixed size, std::uint64_t length, bool back)
        : centre(static_cast<double>(corner) + 0.5 * static_cast<double>(size)),
          half(0.5 * static_cast<double>(size) + kSlack),
          per_unit(length == 0 ? kForEver : (back ? -1 : 1) / static_cast<double>(length)) {}
    Stay at(Fixed corner, Fixed size) const {
      const double other_half = 0.5 * static_cast<double>(size);
      const double middle = (static_cast<double>(corner) + other_half - centre) * per_unit;
      const double length = (half + other_half) * std::abs(per_unit);
      return {middle - length, middle + length};
    }
  };

  Axis m_x;
  Axis m_y;
};

}  // namespace df
