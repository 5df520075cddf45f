#include <gtest/gtest.h>

#include <limits>

#include "shared/replica/ViewFollow.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"

namespace naiad {
namespace {

df::FixedVector at(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

ViewFrame frame(double x, double y) {
  return {at(x, y), at(60, 30), {at(0, 0), at(200, 100)}};
}

TEST(ViewFollow, StaysWhileTheObjectIsInTheInnerThird) {
  EXPECT_EQ(followView(frame(50, 40), at(70, 50)), at(50, 40));
  EXPECT_EQ(followView(frame(50, 40), at(90, 60)), at(50, 40));
}

TEST(ViewFollow, MovesByJustAsMuchAsItTakes) {
  EXPECT_EQ(followView(frame(50, 40), at(69, 50)), at(49, 40));
  EXPECT_EQ(followView(frame(50, 40), at(90.25, 60)), at(50.25, 40));
  EXPECT_EQ(followView(frame(50, 40), at(70, 49)), at(50, 39));
  EXPECT_EQ(followView(frame(50, 40), at(70, 62.5)), at(50, 42.5));
}

TEST(ViewFollow, StaysInsideTheBoundary) {
  EXPECT_EQ(followView(frame(50, 40), at(3, 3)), at(0, 0));
  EXPECT_EQ(followView(frame(50, 40), at(1000, 1000)), at(140, 70));
  EXPECT_EQ(clampView(frame(0, 0), at(-5, 90)), at(0, 70));
}

TEST(ViewFollow, BeginsAtTheCornerOfABoundarySmallerThanTheView) {
  ViewFrame f = frame(50, 40);
  f.boundary = {at(-10, 5), at(59, 30)};
  EXPECT_EQ(clampView(f, at(50, 40)), at(-10, 5));
  EXPECT_EQ(followView(f, at(55, 77)), at(-10, 5));
}

TEST(ViewFollow, ExtremesSaturate) {
  const df::Fixed most = std::numeric_limits<df::Fixed>::max();
  const df::Fixed least = std::numeric_limits<df::Fixed>::min();
  SplitMix64 rng(5);
  const df::Fixed some[] = {most, least, 0, most - 1, least + 1};
  const auto any = [&] { return some[rng.below(5)]; };
  for (int i = 0; i < 2000; ++i) {
    const df::Fixed width = any();
    const ViewFrame f{{any(), any()}, at(60, 30), {{any(), any()}, {width < 0 ? 0 : width, most}}};
    const df::FixedVector corner = followView(f, {any(), any()});
    EXPECT_GE(corner.x, f.boundary.corner.x);
    EXPECT_GE(corner.y, f.boundary.corner.y);
  }
}

TEST(ViewFollow, ModelStaysWithoutAnObjectAndInThePast) {
  const Motion away{10, at(190, 90), at(1, 1), {}};
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, nullptr, 99), at(50, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, &away, 10), at(50, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, &away, 9), at(50, 40));
}

TEST(ViewFollow, ModelOfAStraightPathEqualsFollowingEachStep) {
  SplitMix64 rng(6);
  for (int i = 0; i < 500; ++i) {
    const auto number = [&](double most) { return (rng.unit() - 0.5) * 2 * most; };
    const std::uint32_t known = 0xFFFFFFF0u + static_cast<std::uint32_t>(rng.below(32));
    const Motion motion{known, at(100 + number(90), 50 + number(45)), at(number(3), number(2)), {}};
    ViewFrame stepped = frame(70 + number(70), 35 + number(35));
    stepped.corner = clampView(stepped, stepped.corner);
    const ViewFrame start = stepped;
    for (std::uint32_t n = 1; n < 60; ++n) {
      stepped.corner = followView(stepped, positionAt(motion, known + n));
      ASSERT_EQ(viewCornerAt(start, known, &motion, known + n), stepped.corner)
          << "path " << i << ", tick " << n;
    }
  }
}

TEST(ViewFollow, ModelBeginsAtTheBaseOfANewerMotion) {
  // The object came from the left at tick 5; where it would have been before does not matter.
  const Motion motion{5, at(100, 55), at(-10, 0), {}};
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 5), at(60, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 7), at(60, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 8), at(50, 40));
}

}  // namespace
}  // namespace naiad
