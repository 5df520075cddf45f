#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <tuple>

#include "tests/server/engine/Probe.h"
#include "tests/support/Sanitizers.h"

namespace df::test {
namespace {

const Box kCharacter(Vector(-0.5, -0.5), 1, 1);

class FindFree : public WorldTest {
 protected:
  FindFree() { WM.setBoundary(Box(Vector(-1000, -1000), 2000, 2000)); }

  static Object* make(double x, double y, Solidness solidness = HARD) {
    auto* p = new PlacedObject(Vector(x, y));
    p->setSolidness(solidness);
    return p;
  }
  static Object* makeBlock(Box box) {
    Object* p = make(0, 0);
    p->setBox(box);
    return p;
  }

  /// Returns the expected result, by testing all Objects at all offsets of up to `reach` cells.
  static std::optional<Vector> lookEverywhere(Box box, Vector near, int reach) {
    std::vector<std::tuple<int, int, int>> offsets;
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) offsets.emplace_back(x * x + y * y, y, x);
    }
    std::sort(offsets.begin(), offsets.end());
    auto* p_probe = new Object;
    p_probe->setSolidness(SPECTRAL);
    p_probe->setBox(box);
    std::optional<Vector> found;
    const Box boundary = WM.getBoundary();
    for (const auto& [distance, y, x] : offsets) {
      const Vector at(near.x() + x, near.y() + y);
      const Vector low = at + box.getCorner();
      const Vector end = boundary.getCorner() + Vector(boundary.width(), boundary.height());
      const bool inside = low.x() >= boundary.getCorner().x() && low.y() >= boundary.getCorner().y() &&
                          low.x() + box.width() <= end.x() && low.y() + box.height() <= end.y();
      if (!inside || WM.isCollision(p_probe, at)) continue;
      found = at;
      break;
    }
    delete p_probe;
    return found;
  }
};

TEST_F(FindFree, EmptyWorldReturnsTheRequestedPosition) {
  EXPECT_EQ(WM.findFree(kCharacter, Vector(3.25, 4.5)), Vector(3.25, 4.5));
}

TEST_F(FindFree, TakesTheNearestThenTheHighestThenTheLeftmost) {
  make(10, 10);
  // Objects one cell apart would touch.
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10, 10)), Vector(10, 8));
  make(10, 7);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10, 10)), Vector(8, 10));
  make(7, 10);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10, 10)), Vector(12, 10));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10.5, 10)), Vector(11.5, 10));  // half a cell apart
}

TEST_F(FindFree, SoftObjectsTakeSpaceSpectralAndInactiveDoNot) {
  Object* p = make(10, 10, SOFT);
  EXPECT_NE(WM.findFree(kCharacter, Vector(10, 10)), Vector(10, 10));
  p->setSolidness(SPECTRAL);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10, 10)), Vector(10, 10));
  p->setSolidness(HARD);
  p->setActive(false);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(10, 10)), Vector(10, 10));
}

TEST_F(FindFree, StaysInsideTheBoundaryEdgesIncluded) {
  WM.setBoundary(Box(Vector(0, 0), 10, 5));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0.5, 0.5)), Vector(0.5, 0.5));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0, 0)), Vector(1, 1));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(-20.5, 30.5)), Vector(0.5, 4.5));
  EXPECT_EQ(WM.findFree(Box(Vector(), 10, 5), Vector(3, -2)), Vector(0, 0));
  EXPECT_EQ(WM.findFree(Box(Vector(), 10, 5), Vector(3.5, -2)), std::nullopt);
  EXPECT_EQ(WM.findFree(Box(Vector(), 10.5, 5), Vector(0, 0)), std::nullopt);
}

TEST_F(FindFree, GivesUpBeyondAThousandCells) {
  WM.setBoundary(Box(Vector(), 1e6, 100));
  makeBlock(Box(Vector(-100, -100), 2000, 1000));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(901.5, 10)), Vector(1901.5, 10));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(900.25, 10)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(5000, 1101)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(5000, 1099)), Vector(5000, 99));
}

TEST_F(FindFree, NumbersOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WM.findFree(kCharacter, Vector(nan, 0)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0, 3e9)), std::nullopt);
  EXPECT_EQ(WM.findFree(Box(Vector(), -1, 1), Vector()), std::nullopt);
  EXPECT_EQ(WM.findFree(Box(Vector(), 1, 2e6), Vector()), std::nullopt);
  EXPECT_EQ(world.log().refusals(), 4u);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(2e9, -2e9)), std::nullopt);  // valid, but far from the boundary
  EXPECT_EQ(world.log().refusals(), 4u);
}

TEST_F(FindFree, BoxesOfAnySizeFit) {
  makeBlock(Box(Vector(-20, -3), 40, 6));
  EXPECT_EQ(WM.findFree(Box(Vector(-5, -2), 10, 4), Vector(0, 0)), Vector(0, -6));
  EXPECT_EQ(WM.findFree(Box(Vector(), 0, 0), Vector(0, 2.5)), Vector(0, 3.5));
}

TEST_F(FindFree, MatchesATestOfAllObjects) {
  std::mt19937 random(7);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  for (int round = 0; round < 60 / naiad::test::kShare; ++round) {
    world.shutDown();
    WM.setBoundary(Box(Vector(within(-30, -5), within(-30, -5)), within(10, 50), within(10, 50)));
    const int count = static_cast<int>(within(0, 250));
    for (int i = 0; i < count; ++i) {
      const bool whole = i % 2 == 0;
      const Vector at(within(-30, 30), within(-30, 30));
      Object* p = make(whole ? std::round(at.x()) : at.x(), whole ? std::round(at.y()) : at.y());
      if (i % 5 == 0) p->setBox(Box(Vector(within(-4, 0), -1), within(0, 7), within(0, 3)));
    }
    for (int i = 0; i < 5; ++i) {
      const Box box = i % 2 == 0 ? kCharacter : Box(Vector(-1, within(-2, 1)), within(0, 5), within(0, 5));
      const Vector near(within(-40, 40), i % 2 == 0 ? within(-40, 40) : std::round(within(-20, 20)));
      const auto found = WM.findFree(box, near);
      const auto expected = lookEverywhere(box, near, 90);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!found) continue;
      EXPECT_NEAR(found->x(), expected->x(), 1e-8);
      EXPECT_NEAR(found->y(), expected->y(), 1e-8);
    }
  }
}

TEST_F(FindFree, FindsSpaceAroundThousandsOfObjects) {
  for (int y = -150; y <= 150; ++y) {
    for (int x = -150; x <= 150; ++x) make(x, y);
  }
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0, 0)), Vector(0, -152));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(3, 100)), Vector(3, 152));
}

}  // namespace
}  // namespace df::test
