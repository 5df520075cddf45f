// The oracle compares findFree() with a test of all Objects, in random worlds.
#include <optional>

#include "tests/server/engine/Probe.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

const Box kCharacter(Vector(-0.5, -0.5), 1, 1);

class FindFree : public WorldTest {
 protected:
  FindFree() { WM.setBoundary(Box(Vector(-1000, -1000), 2000, 2000)); }
};

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
  (new Object)->setBox(Box(Vector(-100, -100), 2000, 1000));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(901.5, 10)), Vector(1901.5, 10));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(900.25, 10)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(5000, 1101)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(5000, 1099)), Vector(5000, 99));
}

TEST_F(FindFree, NumbersOutOfRangeAreRefused) {
  EXPECT_EQ(WM.findFree(kCharacter, Vector(kNan, 0)), std::nullopt);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0, 3e9)), std::nullopt);
  EXPECT_EQ(WM.findFree(Box(Vector(), -1, 1), Vector()), std::nullopt);
  EXPECT_EQ(WM.findFree(Box(Vector(), 1, 2e6), Vector()), std::nullopt);
  EXPECT_EQ(world.log().refusals(), 4u);
  EXPECT_EQ(WM.findFree(kCharacter, Vector(2e9, -2e9)), std::nullopt);  // valid, but far from the boundary
  EXPECT_EQ(world.log().refusals(), 4u);
}

TEST_F(FindFree, FindsSpaceAroundThousandsOfObjects) {
  for (int y = -150; y <= 150; ++y) {
    for (int x = -150; x <= 150; ++x) new PlacedObject(Vector(x, y));
  }
  EXPECT_EQ(WM.findFree(kCharacter, Vector(0, 0)), Vector(0, -152));
  EXPECT_EQ(WM.findFree(kCharacter, Vector(3, 100)), Vector(3, 152));
}

}  // namespace
}  // namespace df::test
