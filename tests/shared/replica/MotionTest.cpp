#include <gtest/gtest.h>

#include <limits>

#include "shared/replica/Motion.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using df::Fixed;

Fixed wrapAdd(Fixed a, Fixed b) {
  return static_cast<Fixed>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// Advances the motion by one tick, like the world does.
Motion stepped(Motion m) {
  m.position = {wrapAdd(m.position.x, m.velocity.x), wrapAdd(m.position.y, m.velocity.y)};
  m.velocity = {wrapAdd(m.velocity.x, m.acceleration.x), wrapAdd(m.velocity.y, m.acceleration.y)};
  ++m.tick;
  return m;
}

Motion randomMotion(SplitMix64& rng, int bits) {
  const auto number = [&] { return static_cast<Fixed>(rng.next()) >> (64 - bits); };
  return {static_cast<std::uint32_t>(rng.next()),
          {number(), number()},
          {number(), number()},
          {number(), number()}};
}

TEST(Motion, ClosedFormEqualsSteppingBitForBit) {
  SplitMix64 rng(1);
  for (int i = 0; i < 300; ++i) {
    const Motion start = randomMotion(rng, 20 + i % 45);  // the last motions overflow and wrap
    Motion m = start;
    for (int n = 0; n < 200; ++n) {
      ASSERT_EQ(positionAt(start, m.tick), m.position) << "motion " << i << " after " << n << " ticks";
      ASSERT_EQ(rebase(start, m.tick), m);
      m = stepped(m);
    }
  }
}

TEST(Motion, PositionsBeforeTheBaseTickAreExact) {
  SplitMix64 rng(2);
  for (int i = 0; i < 100; ++i) {
    const Motion start = randomMotion(rng, 64);
    Motion m = start;
    for (int n = 0; n < 50; ++n) m = stepped(m);
    ASSERT_EQ(positionAt(m, start.tick), start.position);
    ASSERT_EQ(rebase(m, start.tick), start);
  }
}

TEST(Motion, TickCounterWrapIsHandled) {
  const Motion m{0xFFFFFFFE, {10, 0}, {3, 0}, {1, 0}};
  EXPECT_EQ(positionAt(m, 1).x, 10 + 3 * 3 + 3);
}

TEST(Motion, ExtremesWrapWithoutTrapping) {
  const Fixed most = std::numeric_limits<Fixed>::max();
  const Fixed least = std::numeric_limits<Fixed>::min();
  const Motion m{0, {most, least}, {most, least}, {least, most}};
  for (const std::uint32_t tick : {0u, 1u, 0x7FFFFFFFu, 0x80000001u, 0xFFFFFFFFu})
    EXPECT_EQ(positionAt(rebase(m, tick), 0), m.position) << tick;
  EXPECT_EQ(positionAt(m, 0x80000000u), positionAt(m, 0x80000000u));  // any answer is allowed
}

TEST(Motion, IsMovingIfPositionWillEverChange) {
  EXPECT_FALSE(isMoving({5, {1, 2}, {}, {}}));
  EXPECT_TRUE(isMoving({5, {}, {0, -1}, {}}));
  EXPECT_TRUE(isMoving({5, {}, {}, {1, 0}}));
}

}  // namespace
}  // namespace naiad
