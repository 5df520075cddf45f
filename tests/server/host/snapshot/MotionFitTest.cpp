#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "host/snapshot/MotionFit.h"
#include "shared/replica/MotionCodec.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
using Offsets = std::vector<df::FixedVector>;

int bitsOf(df::FixedVector v) {
  const auto all = static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y);
  return std::max(0, df::kFixedBits - std::countr_zero(all));
}

bool drawsTheSame(const Motion& a, const Motion& b, const Offsets& offsets, std::uint32_t horizon) {
  for (std::uint32_t n = 0; n <= horizon; ++n) {
    const df::FixedVector p = positionAt(a, a.tick + n);
    const df::FixedVector q = positionAt(b, a.tick + n);
    for (const df::FixedVector& offset : offsets) {
      if (df::cellOf(p.x + offset.x) != df::cellOf(q.x + offset.x) ||
          df::cellOf(p.y + offset.y) != df::cellOf(q.y + offset.y)) {
        return false;
      }
    }
  }
  return true;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : m_rng(seed) {}

  std::uint64_t below(std::uint64_t n) { return m_rng.below(n); }
  /// Returns a random number within ±most, with a random number of fraction bits.
  df::Fixed coordinate(double most) {
    const auto exact =
        static_cast<df::Fixed>((m_rng.unit() - 0.5) * 2 * most * static_cast<double>(df::kFixedOne));
    return m_rng.below(2) == 0 ? exact : exact & -(df::Fixed{1} << m_rng.below(df::kFixedBits + 1));
  }
  df::FixedVector vector(double most) {
    const df::Fixed x = coordinate(most);
    return {x, coordinate(most)};
  }
  Motion motion() {
    static constexpr double kPositions[] = {10, 1000, 1.9e9};
    static constexpr double kVelocities[] = {0.01, 0.5, 3, 100, 4000};
    Motion m;
    m.tick = static_cast<std::uint32_t>(m_rng.next());
    m.position = vector(kPositions[m_rng.below(3)]);
    if (m_rng.below(5) != 0) m.velocity = vector(kVelocities[m_rng.below(5)]);
    return m;
  }
  Offsets offsets() {
    Offsets all(1);
    for (auto n = m_rng.below(5); n > 0; --n) {
      const df::Fixed unit = df::kFixedOne / (m_rng.below(2) == 0 ? 2 : 256);
      const df::Fixed x = unit * (static_cast<df::Fixed>(m_rng.below(2000)) - 1000);
      all.push_back({x, unit * (static_cast<df::Fixed>(m_rng.below(2000)) - 1000)});
    }
    return all;
  }

 private:
  SplitMix64 m_rng;
};

TEST(MotionFit, DrawsTheSameCellsWithoutMoreBits) {
  Random random(1);
  int coarser = 0;
  for (int i = 0; i < 6000; ++i) {
    const Motion truth = random.motion();
    const Offsets offsets = random.offsets();
    const auto horizon = static_cast<std::uint32_t>(random.below(i % 20 == 0 ? kMaxHorizon + 1 : 150));
    const Motion fitted = fitMotion(truth, offsets, horizon);
    ASSERT_EQ(fitted.tick, truth.tick);
    ASSERT_EQ(fitted.acceleration, df::FixedVector{});
    ASSERT_TRUE(drawsTheSame(truth, fitted, offsets, horizon)) << "round " << i;
    const int before = bitsOf(truth.position) + bitsOf(truth.velocity);
    const int after = bitsOf(fitted.position) + bitsOf(fitted.velocity);
    ASSERT_LE(after, before) << "round " << i;
    coarser += after < before ? 1 : 0;
  }
  EXPECT_GT(coarser, 3000);
}

TEST(MotionFit, ShortNumbersStayAsTheyAre) {
  const Offsets offsets(1);
  for (const double v : {0.25, -0.25, 0.5, 1.0, -3.0, 0.75}) {
    const Motion truth{10, cellsAt(5, 7), cellsAt(v, 0), {}};
    const Motion fitted = fitMotion(truth, offsets, 64);
    EXPECT_EQ(fitted.velocity, truth.velocity) << v;
    EXPECT_EQ(bitsOf(fitted.position), 0);
  }
}

TEST(MotionFit, StandingObjectIsRoundedToItsCell) {
  const Motion truth{10, {df::fromCells(5) + 12345, df::fromCells(-7) - 54321}, {}, {}};
  const Motion fitted = fitMotion(truth, Offsets(1), 64);
  EXPECT_EQ(fitted.position, cellsAt(5, -7));
  EXPECT_EQ(fitted.velocity, df::FixedVector{});
}

TEST(MotionFit, UnfittableMotionIsReturnedUnchanged) {
  const Offsets offsets(1);
  const Motion odd{10, {12345, 67}, {891, 23}, {}};
  EXPECT_NE(fitMotion(odd, offsets, kMaxHorizon), odd);
  EXPECT_EQ(fitMotion(odd, offsets, kMaxHorizon + 1), odd);
  Motion accelerated = odd;
  accelerated.acceleration = {0, 1};
  EXPECT_EQ(fitMotion(accelerated, offsets, 64), accelerated);
  Motion fast = odd;
  fast.velocity.y = df::fromCells(5000) + 1;
  EXPECT_EQ(fitMotion(fast, offsets, 64), fast);
}

// Fewer fraction bits shorten the message; fractions are written twice, for x and for y.
TEST(MotionFit, SlowPathsTakeFewBits) {
  Random random(2);
  double bits = 0;
  constexpr int kRounds = 3000;
  for (int i = 0; i < kRounds; ++i) {
    Motion truth;
    truth.position = {random.coordinate(100) | 1, random.coordinate(100) | 1};
    truth.velocity = {random.coordinate(0.5) | 1, random.coordinate(0.5) | 1};
    const Motion fitted = fitMotion(truth, Offsets(1), 64);
    bits += fractionBits(fitted.position) + fractionBits(fitted.velocity);
  }
  EXPECT_LT(bits / kRounds, 14);
}

}  // namespace
}  // namespace naiad
