#include "host/snapshot/MotionFit.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <optional>
#include <vector>

namespace naiad {

namespace {

using df::Fixed;

constexpr Fixed kHalf = df::kFixedOne / 2;
/// Maximum speed of fitted motions: far more cells per tick than a view has. All sums below stay in range.
constexpr Fixed kFastest = Fixed{4096} * df::kFixedOne;

/// A tick, counted from the first one, and the position of a character within its cell in that tick.
struct HullPoint {
  Fixed tick = 0;
  Fixed within = 0;
};

/// One half of the convex hull of points, sorted by tick. It limits which straight paths draw the right
/// cells. A straight path modulo a cell has few hull points, however many ticks it lasts.
class HalfHull {
 public:
  /// `side`: 1 for the lower half, −1 for the upper one.
  explicit HalfHull(Fixed side) : m_side(side) {}

  void add(HullPoint place) {
    while (m_places.size() >= 2 && isWithin(place)) m_places.pop_back();
    m_places.push_back(place);
  }
  /// Returns the minimum of `within + tick · slope` over all points; for the upper half, the maximum.
  Fixed extreme(Fixed slope) const {
    Fixed best = m_places.front().within;
    for (const HullPoint& place : m_places) {
      const Fixed value = place.within + place.tick * slope;
      if ((best - value) * m_side > 0) best = value;
    }
    return best;
  }

 private:
  /// True if the last point lies inside the hull once `next` is added.
  bool isWithin(HullPoint next) const {
    const HullPoint& last = m_places.back();
    const HullPoint& before = m_places[m_places.size() - 2];
    return ((last.within - before.within) * (next.tick - before.tick) -
            (next.within - before.within) * (last.tick - before.tick)) *
               m_side >=
           0;
  }

  Fixed m_side;
  std::vector<HullPoint> m_places;
};

/// One axis of a path. Finds coarse pairs of position and velocity that draw the same cells.
class AxisFit {
 public:
  AxisFit(Fixed position, Fixed velocity, const std::vector<Fixed>& offsets, std::uint32_t horizon)
      : m_position(position), m_velocity(velocity), m_horizon(velocity == 0 ? 0 : horizon) {
    Fixed place = position + kHalf;
    for (std::uint32_t n = 0; n <= m_horizon; ++n, place += velocity) {
      Fixed low = df::kFixedOne;
      Fixed high = 0;
      for (const Fixed offset : offsets) {
        const Fixed within = (place + offset) & (df::kFixedOne - 1);
        low = std::min(low, within);
        high = std::max(high, within);
      }
      m_lower.add({n, low});
      m_upper.add({n, high});
    }
  }

  struct Pair {
    Fixed position = 0;
    Fixed velocity = 0;
    int position_bits = df::kFixedBits;
  };

  /// Tries the velocities of `bits` fractional bits next to the true one, and returns the pair whose position
  /// has the fewest; nullopt if none draws the right cells.
  std::optional<Pair> withVelocityBits(int bits) const {
    const Fixed step = Fixed{1} << (df::kFixedBits - bits);
    const Fixed below = m_velocity & ~(step - 1);
    std::optional<Pair> best;
    for (const Fixed velocity : {below, below + step}) {
      const std::optional<Pair> pair = positionFor(velocity);
      if (pair && (!best || pair->position_bits < best->position_bits)) best = pair;
      if (below == m_velocity) break;
    }
    return best;
  }

 private:
  std::optional<Pair> positionFor(Fixed velocity) const {
    // The bounds are relative to the true position; the coarse path drifts away from it tick by tick.
    const Fixed drift = velocity - m_velocity;
    if (std::abs(drift) > 2 * df::kFixedOne / std::max<Fixed>(m_horizon, 1)) return std::nullopt;
    const Fixed low = std::max(-df::kFixedOne, -m_lower.extreme(drift));
    const Fixed high = std::min(df::kFixedOne, df::kFixedOne - m_upper.extreme(drift));
    if (low >= high) return std::nullopt;
    const Fixed position = simplest(m_position + low, m_position + high);
    return Pair{position, velocity, bitsOf(position)};
  }

  static int bitsOf(Fixed value) {
    return std::max(0, df::kFixedBits - std::countr_zero(static_cast<std::uint64_t>(value)));
  }

  /// Returns the number in [low, high) with the fewest fractional bits.
  static Fixed simplest(Fixed low, Fixed high) {
    for (int bits = 0;; ++bits) {
      const Fixed step = Fixed{1} << (df::kFixedBits - bits);
      const Fixed up = (low + step - 1) & ~(step - 1);
      if (up < high) return up;
    }
  }

  Fixed m_position;
  Fixed m_velocity;
  std::uint32_t m_horizon;
  HalfHull m_lower{1};
  HalfHull m_upper{-1};
};

/// Returns the distinct fractional parts of the offsets. Whole cells do not affect whether a path fits.
std::vector<Fixed> fractions(std::span<const df::FixedVector> offsets, Fixed df::FixedVector::*axis) {
  std::vector<Fixed> distinct;
  for (const df::FixedVector& offset : offsets) {
    const Fixed fraction = offset.*axis & (df::kFixedOne - 1);
    if (std::find(distinct.begin(), distinct.end(), fraction) == distinct.end()) distinct.push_back(fraction);
  }
  return distinct;
}

bool isFast(Fixed v) {
  return v > kFastest || v < -kFastest;
}

}  // namespace

Motion fitMotion(const Motion& truth, std::span<const df::FixedVector> offsets, std::uint32_t horizon) {
  const df::FixedVector zero;
  if (truth.acceleration != zero || isFast(truth.velocity.x) || isFast(truth.velocity.y) ||
      horizon > kMaxHorizon) {
    return truth;
  }
  const std::vector<Fixed> x_offsets = fractions(offsets, &df::FixedVector::x);
  const std::vector<Fixed> y_offsets = fractions(offsets, &df::FixedVector::y);
  const AxisFit x(truth.position.x, truth.velocity.x, x_offsets, horizon);
  const AxisFit y(truth.position.y, truth.velocity.y, y_offsets, horizon);
  Motion best = truth;
  int fewest = 2 * df::kFixedBits;
  for (int bits = 0; bits < fewest && bits <= df::kFixedBits; ++bits) {
    const auto along_x = x.withVelocityBits(bits);
    const auto along_y = along_x ? y.withVelocityBits(bits) : std::nullopt;
    if (!along_y) continue;
    const int all = bits + std::max(along_x->position_bits, along_y->position_bits);
    if (all >= fewest) continue;
    fewest = all;
    best.position = {along_x->position, along_y->position};
    best.velocity = {along_x->velocity, along_y->velocity};
  }
  return best;
}

}  // namespace naiad
