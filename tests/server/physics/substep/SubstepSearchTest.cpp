// The search for contacts in a SubstepWorld: that it finds bodies, and its work.

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "SubstepScene.h"

namespace naiad::physics {
namespace {

using namespace test;

std::vector<int> addCloud(SubstepScene& scene, double speed) {
  std::vector<int> ids;
  const ConvexShape crate = boxShape(0.5, 0.5);
  for (int i = 0; i < 100; ++i) {
    RigidBody body = movable({1.3 * (i % 10), -5 - 1.3 * (i / 10)}, crate);
    body.velocity = {0, speed};
    ids.push_back(scene.add(body, crate));
  }
  return ids;
}

TEST(SubstepSearch, BodiesFallingTogetherNeedNoContacts) {
  SubstepScene scene(awake());
  addCloud(scene, 0.9);
  scene.ticks(20);
  EXPECT_EQ(scene.world.counters().contacts, 0);
}

// The upper bodies touch those that the floor has stopped earlier in the tick.
TEST(SubstepSearch, FallingBodiesFindStoppedOnesInTheTick) {
  SubstepScene scene(awake());
  scene.addFloor();
  addCloud(scene, 0.3);
  EXPECT_LT(scene.deepest(60), 0.1);
  EXPECT_GT(scene.world.counters().contacts, 1000);
}

// One body flies into the cloud from the side, faster than the cloud moves, from various places.
TEST(SubstepSearch, BodyHitInFlightHitsTheNext) {
  double most = 0, sum = 0;
  constexpr int kStarts = 50;
  for (int i = 0; i < kStarts; ++i) {
    SubstepScene scene(awake());
    const std::vector<int> ids = addCloud(scene, 0.9);
    const ConvexShape crate = boxShape(0.5, 0.5);
    RigidBody body = movable({-3 + 0.026 * (i % 5), -5 + 0.012 * i}, crate);
    body.velocity = {0.8, 0.9};
    body.inverse_mass = 0.01;
    scene.add(body, crate);
    const double deepest = scene.deepest(30);
    sum += deepest;
    most = std::max(most, deepest);
    EXPECT_GT(scene.world.body(ids[9]).velocity.x, 0.1);  // the last body of the row that it hit
  }
  EXPECT_LT(sum / kStarts, 0.1);
  EXPECT_LT(most, 0.2);
}

// The work is limited. In a row whose pairs are not sorted, a sweep propagates a push by only one body.
TEST(SubstepSearch, PushAlongAShuffledRowHasBoundedWork) {
  constexpr int kCrates = 400;
  SubstepScene scene(awake());
  std::vector<int> rows(kCrates);
  std::iota(rows.begin(), rows.end(), 0);
  std::shuffle(rows.begin(), rows.end(), std::mt19937(3));
  const ConvexShape crate = boxShape(0.5, 0.5);
  for (const int row : rows) {
    RigidBody body = movable({0, -5 - 1.3 * row}, crate);
    body.velocity = {0, 0.9};
    scene.add(body, crate);
  }
  RigidBody shot = movable({0, -3.7}, crate);
  shot.velocity = {0, -300};
  const int id = scene.add(shot, crate);
  scene.ticks(1);
  EXPECT_LT(scene.at(id).y, -3) << "it was stopped by the first one";
  EXPECT_GE(scene.world.counters().contacts, 1);
  EXPECT_GT(scene.world.counters().sweeps, 8) << "or nothing was to be followed";
  EXPECT_LE(scene.world.counters().sweeps, 32);
}

TEST(SubstepSearch, MovedImmovableBodyIsFoundAtItsNewPlace) {
  SubstepScene scene(awake());
  const int shelf = scene.add(immovable({100, 5}), boxShape(5, 0.5));
  const int crate = scene.addCrate({0, 0});
  scene.ticks(5);
  ASSERT_TRUE(scene.world.set(shelf, immovable({0, 5})));
  scene.ticks(60);
  EXPECT_NEAR(scene.at(crate).y, 4, 0.05);
}

TEST(SubstepSearch, ChangingOneShapeLeavesEqualOnesUnchanged) {
  SubstepScene scene(awake());
  scene.addFloor();
  const int first = scene.addCrate({0, -0.5}), second = scene.addCrate({5, -0.5});
  const ConvexShape low = boxShape(0.5, 0.25);
  ASSERT_TRUE(scene.world.setShapes(first, std::span(&low, 1)));
  ASSERT_TRUE(scene.world.remove(scene.addCrate({10, -0.5})));
  scene.ticks(40);
  EXPECT_NEAR(scene.at(first).y, -0.25, 0.02);
  EXPECT_NEAR(scene.at(second).y, -0.5, 0.02);
}

}  // namespace
}  // namespace naiad::physics
