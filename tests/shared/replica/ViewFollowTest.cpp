#include <gtest/gtest.h>

#include <limits>

#include "shared/replica/ViewFollow.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
ViewFrame frame(double x, double y) {
  return {cellsAt(x, y), cellsAt(60, 30), {cellsAt(0, 0), cellsAt(200, 100)}};
}

TEST(ViewFollow, StaysWhileTheObjectIsInTheInnerThird) {
  EXPECT_EQ(followView(frame(50, 40), cellsAt(70, 50)), cellsAt(50, 40));
  EXPECT_EQ(followView(frame(50, 40), cellsAt(90, 60)), cellsAt(50, 40));
}

TEST(ViewFollow, MovesNoFartherThanNeeded) {
  EXPECT_EQ(followView(frame(50, 40), cellsAt(69, 50)), cellsAt(49, 40));
  EXPECT_EQ(followView(frame(50, 40), cellsAt(90.25, 60)), cellsAt(50.25, 40));
  EXPECT_EQ(followView(frame(50, 40), cellsAt(70, 49)), cellsAt(50, 39));
  EXPECT_EQ(followView(frame(50, 40), cellsAt(70, 62.5)), cellsAt(50, 42.5));
}

TEST(ViewFollow, StaysInsideTheBoundary) {
  EXPECT_EQ(followView(frame(50, 40), cellsAt(3, 3)), cellsAt(0, 0));
  EXPECT_EQ(followView(frame(50, 40), cellsAt(1000, 1000)), cellsAt(140, 70));
  EXPECT_EQ(clampView(frame(0, 0), cellsAt(-5, 90)), cellsAt(0, 70));
}

TEST(ViewFollow, SmallBoundaryPinsTheViewToItsCorner) {
  ViewFrame f = frame(50, 40);
  f.boundary = {cellsAt(-10, 5), cellsAt(59, 30)};
  EXPECT_EQ(clampView(f, cellsAt(50, 40)), cellsAt(-10, 5));
  EXPECT_EQ(followView(f, cellsAt(55, 77)), cellsAt(-10, 5));
}

TEST(ViewFollow, ExtremesSaturate) {
  const df::Fixed most = std::numeric_limits<df::Fixed>::max();
  const df::Fixed least = std::numeric_limits<df::Fixed>::min();
  SplitMix64 rng(5);
  const df::Fixed some[] = {most, least, 0, most - 1, least + 1};
  const auto any = [&] { return some[rng.below(5)]; };
  for (int i = 0; i < 2000; ++i) {
    const df::Fixed width = any();
    const ViewFrame f{{any(), any()}, cellsAt(60, 30), {{any(), any()}, {width < 0 ? 0 : width, most}}};
    const df::FixedVector corner = followView(f, {any(), any()});
    EXPECT_GE(corner.x, f.boundary.corner.x);
    EXPECT_GE(corner.y, f.boundary.corner.y);
  }
}

TEST(ViewFollow, ModelKeepsTheCornerWithoutObjectOrInPast) {
  const Motion away{10, cellsAt(190, 90), cellsAt(1, 1), {}};
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, nullptr, 99), cellsAt(50, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, &away, 10), cellsAt(50, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 10, &away, 9), cellsAt(50, 40));
}

TEST(ViewFollow, ModelOfAStraightPathEqualsFollowingEachStep) {
  SplitMix64 rng(6);
  for (int i = 0; i < 500; ++i) {
    const auto number = [&](double most) { return (rng.unit() - 0.5) * 2 * most; };
    const std::uint32_t known = 0xFFFFFFF0u + static_cast<std::uint32_t>(rng.below(32));
    const Motion motion{known, cellsAt(100 + number(90), 50 + number(45)), cellsAt(number(3), number(2)), {}};
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
  // The object came from the left at tick 5. Its earlier path does not matter.
  const Motion motion{5, cellsAt(100, 55), cellsAt(-10, 0), {}};
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 5), cellsAt(60, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 7), cellsAt(60, 40));
  EXPECT_EQ(viewCornerAt(frame(50, 40), 1, &motion, 8), cellsAt(50, 40));
}

}  // namespace
}  // namespace naiad
