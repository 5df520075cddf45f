#include <gtest/gtest.h>

#include "RandomRecords.h"
#include "shared/replica/MotionCodec.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
using test::RandomRecords;

std::size_t bitsOf(const Motion& motion, const Origin& origin) {
  BitWriter out;
  writeMotion(out, motion, origin);
  return out.bitCount();
}

void expectExact(const Motion& motion, const Origin& origin) {
  BitWriter out;
  writeMotion(out, motion, origin);
  const std::string bytes = out.bytes();
  BitReader in(bytes);
  const Motion read = readMotion(in, motion.tick, origin);
  ASSERT_TRUE(in.atEnd());
  ASSERT_EQ(read, motion);
  BitWriter shared;
  writeMotion(shared, shareMotion(motion), origin);
  ASSERT_EQ(shared.bitCount(), out.bitCount());
  ASSERT_EQ(shared.bytes(), bytes);
}

TEST(MotionCodec, RandomMotionsAreExactFromAnyOrigin) {
  RandomRecords random(1);
  for (int i = 0; i < 40'000; ++i) {
    const Origin origin = random.origin();
    Motion motion = random.motion(static_cast<std::uint32_t>(i));
    if (i % 2 == 0) {  // near the origin
      motion.position = {(df::Fixed{origin.corner.x} << df::kFixedBits) + random.coordinate(300),
                         (df::Fixed{origin.corner.y} << df::kFixedBits) + random.coordinate(300)};
    }
    expectExact(motion, origin);
    if (HasFatalFailure()) FAIL() << "round " << i;
  }
}

TEST(MotionCodec, EveryMagnitudeAndEveryFractionIsExact) {
  const Origin origin{{-40, 12}, 7, 5, 0};
  for (int bit = 0; bit < 63; ++bit) {
    for (const df::Fixed value : {df::Fixed{1} << bit, -(df::Fixed{1} << bit), (df::Fixed{1} << bit) - 1}) {
      if (value > kMaxWirePosition || value < -kMaxWirePosition) continue;
      expectExact({3, {value, 0}, {}, {}}, origin);
      expectExact({3, {value, -value}, {}, {}}, {});
      if (value > kMaxWireVelocity || value < -kMaxWireVelocity) continue;
      expectExact({3, {}, {value, 0}, {}}, origin);
      expectExact({3, {}, {0, value}, {-value, 1}}, origin);
    }
  }
  for (const df::Fixed most : {kMaxWirePosition, -kMaxWirePosition}) {
    const df::Fixed fastest = most > 0 ? kMaxWireVelocity : -kMaxWireVelocity;
    expectExact({3, {most, -most}, {fastest, -fastest}, {-fastest, fastest}}, origin);
  }
}

TEST(MotionCodec, MotionAcceleratedPastTheLimitStillFits) {
  const df::Fixed most = *df::toFixed(df::kMaxVelocityCells);
  const Motion fastest{8, {}, {most, -most}, {most, -most}};
  expectExact(rebase(fastest, 9), {});
}

TEST(MotionCodec, OutOfRangeNumbersAreRefused) {
  const auto isRead = [](const Motion& motion) {
    BitWriter out;
    writeMotion(out, motion, {});
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    readMotion(in, motion.tick, {});
    return in.ok();
  };
  EXPECT_TRUE(isRead({0, {kMaxWirePosition, 0}, {}, {}}));
  EXPECT_FALSE(isRead({0, {kMaxWirePosition + 1, 0}, {}, {}}));
  EXPECT_FALSE(isRead({0, {0, -kMaxWirePosition - 1}, {}, {}}));
  EXPECT_FALSE(isRead({0, {}, {kMaxWireVelocity + 1, 0}, {}}));
  EXPECT_FALSE(isRead({0, {}, {1, 0}, {0, -kMaxWireVelocity - 1}}));
}

TEST(MotionCodec, ShortMotionsAreEncodedOnceForAllClients) {
  EXPECT_EQ(shareMotion({1, cellsAt(3, 4), {}, {}}).count, 2 + 4);  // the kind, without a fraction
  EXPECT_GT(shareMotion({1, cellsAt(3.5, 4.25), cellsAt(0.25, 0), {}}).count, 0);
  EXPECT_EQ(shareMotion({1, cellsAt(1.0 / 3, 1.0 / 3), cellsAt(1.0 / 3, 0), {}}).count, 0) << "too long";
}

TEST(MotionCodec, WholeCellsInTheWindowEncodeCompactly) {
  const Origin window{{-10, 5}, 7, 5, 0};
  for (const double x : {-10.0, 0.0, 117.0}) {
    EXPECT_EQ(bitsOf({0, cellsAt(x, 5), {}, {}}, window), 1u + 7 + 5 + 2 + 4);
    EXPECT_EQ(bitsOf({0, cellsAt(x, 36), {}, {}}, window), 1u + 7 + 5 + 2 + 4);
  }
  EXPECT_GT(bitsOf({0, cellsAt(118, 5), {}, {}}, window), 24u) << "the window ends";
  EXPECT_GT(bitsOf({0, cellsAt(0, 37), {}, {}}, window), 24u);
  EXPECT_GT(bitsOf({0, cellsAt(-11, 5), {}, {}}, window), 24u);
  // A quarter of a cell per tick: 2 fractional bits and a sign.
  EXPECT_LE(bitsOf({0, cellsAt(0, 5), cellsAt(-0.25, 0), {}}, window), 32u);
}

TEST(MotionCodec, VectorsAreExactAndLimited) {
  RandomRecords random(6);
  for (int i = 0; i < 5000; ++i) {
    const df::FixedVector v = random.vector(1'000'000);
    BitWriter out;
    writeVector(out, v);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    ASSERT_EQ(readVector(in, df::fromCells(1'000'000)), v);
    ASSERT_TRUE(in.atEnd());
    const df::Fixed most = std::max(std::abs(v.x), std::abs(v.y));
    if (most == 0) continue;
    BitReader strict(bytes);
    readVector(strict, most - 1);
    ASSERT_FALSE(strict.ok());
  }
}

}  // namespace
}  // namespace naiad
