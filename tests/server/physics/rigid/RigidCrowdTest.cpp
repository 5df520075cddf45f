// Bodies created in one place: the work is limited, and bodies that can lie side by side are not affected.

#include <algorithm>
#include <vector>

#include "RigidScene.h"

namespace naiad::physics::test {
namespace {

// Returns two crossed boxes, and a disc beside them.
std::vector<ConvexShape> cross() {
  std::vector<ConvexShape> shapes(3);
  makeBox(1, 0.5, {}, {}, 0, shapes[0]);
  makeBox(0.5, 1.5, {}, {}, 0, shapes[1]);
  makeCircle(0.7, {-1, 0}, shapes[2]);
  return shapes;
}

RigidBody afloat(Vec2 where) {
  RigidBody body;
  body.place = placeAt(where);
  body.inverse_inertia = 0.7;
  return body;
}

double spread(const RigidWorld& world) {
  double farthest = 0;
  for (int id = 0; id < world.idLimit(); ++id) farthest = std::max(farthest, length(whereIs(world, id)));
  return farthest;
}

TEST(RigidCrowd, ContactsGrowWithBodiesNotPairs) {
  constexpr int kMaxOthers = 32, kPoints = 9;  // kPoints: shapes of one body times shapes of the other
  for (const int count : {50, 100, 200}) {
    RigidWorld world(sleepless());
    for (int i = 0; i < count; ++i) world.add(afloat({}), cross());
    world.step();
    EXPECT_LE(world.counters().contacts, count * kMaxOthers * kPoints) << count;
    EXPECT_GT(world.counters().contacts, count);
    EXPECT_TRUE(world.hasThinned()) << count;
  }
}

TEST(RigidCrowd, OverlappingBodiesComeApartGently) {
  constexpr int kMany = 100, kTicks = 400;
  RigidWorld world;
  for (int i = 0; i < kMany; ++i) {
    RigidBody body = afloat({0.01 * (i % 10), 0.01 * (i / 10)});
    body.rotation = rotationBy(0.1 * i);
    world.add(body, cross());
  }
  double fastest = 0;
  for (int i = 0; i < kTicks; ++i) {
    world.step();
    for (int id = 0; id < kMany; ++id) {
      RigidBody body = world.body(id);
      fastest = std::max(fastest, length(body.velocity));
      body.velocity *= 0.95;  // makes the bodies come to rest
      world.set(id, body);
    }
  }
  EXPECT_TRUE(world.hasThinned());
  world.step();
  EXPECT_LT(world.deepest(), 0.01);
  EXPECT_LT(fastest, 2);
  EXPECT_LT(spread(world), 100);
}

// Thin planks in a pile have many others within their length, but all their contacts are kept.
TEST(RigidCrowd, PileOfPlanksKeepsAllContacts) {
  RigidWorld world = onFloor();
  const ConvexShape plank = boxShape(5, 0.1), crate = boxShape(0.5, 0.5);
  for (int i = 0; i < 40; ++i) world.add(movable({0, -0.1 - 0.2 * i}, plank), plank);
  for (int i = 0; i < 40; ++i) world.add(movable({20.0 + i % 8, -0.5 - i / 8}, crate), crate);
  for (int i = 0; i < 60; ++i) world.step();
  EXPECT_GT(world.counters().contacts, 60 * 80);
  EXPECT_FALSE(world.hasThinned());
}

// A tray with a hundred marbles is near all of them, but not in a crowd.
TEST(RigidCrowd, TrayHoldsAHundredMarbles) {
  RigidWorld world = onFloor();
  std::vector<ConvexShape> tray(3);
  makeBox(12, 0.5, {}, {}, 0, tray[0]);
  makeBox(0.5, 3, {-12, -3}, {}, 0, tray[1]);
  makeBox(0.5, 3, {12, -3}, {}, 0, tray[2]);
  world.add(movable({0, -0.5}, tray[0], 50), tray);
  const ConvexShape marble = circleShape(0.4);
  for (int i = 0; i < 100; ++i) {
    world.add(movable({-9.0 + 0.9 * (i % 20) + 0.1 * (i / 20), -1.5 - 0.9 * (i / 20)}, marble), marble);
  }
  for (int i = 0; i < 120; ++i) world.step();
  EXPECT_FALSE(world.hasThinned());
  for (int id = 2; id < world.idLimit(); ++id) {
    EXPECT_LT(whereIs(world, id).y, -1.3) << id;
    EXPECT_LT(std::fabs(whereIs(world, id).x), 12) << id;
  }
}

// Makes rows of crates that lie on one another, and also touch side by side if `apart` is 1.
RigidWorld pyramid(int rows, double apart = 1) {
  RigidWorld world = onFloor();
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      world.add(movable({apart * (i + 0.5 * row), -0.5 - row}, boxShape(0.5, 0.5)), boxShape(0.5, 0.5));
    }
  }
  return world;
}

// The direct solution has a fixed cost in multiplications per contact and round. It is skipped if all rounds
// together would cost too much, because the first ones would be wasted.
TEST(RigidCrowd, DirectSolutionIsSkippedWhenTooExpensive) {
  RigidWorld wide = pyramid(30);
  wide.step();
  EXPECT_EQ(wide.counters().direct_solves, 0);
  EXPECT_EQ(wide.counters().direct_refusals, 1);
  for (int id = 1; id < wide.idLimit(); ++id) EXPECT_TRUE(wide.isGivenUp(id)) << id;

  for (RigidWorld fits : {pyramid(12), pyramid(30, 1.1)}) {
    const Vec2 top = whereIs(fits, fits.idLimit() - 1);
    for (int i = 0; i < 60; ++i) fits.step();
    EXPECT_EQ(fits.counters().direct_failures, 0);
    EXPECT_NEAR(whereIs(fits, fits.idLimit() - 1).y, top.y, 1e-6);
  }
}

// The second half of a sub-step starts from the impulses of the first half.
TEST(RigidCrowd, NewHeapReusesImpulsesOfTheFirstHalf) {
  RigidWorld world = pyramid(10);
  world.step();
  EXPECT_EQ(world.counters().direct_solves, 2);  // only in one sub-step; after it, the impulses are known
  EXPECT_LE(world.counters().direct_rounds, 18);
  EXPECT_EQ(world.counters().direct_failures, 0);
}

}  // namespace
}  // namespace naiad::physics::test
