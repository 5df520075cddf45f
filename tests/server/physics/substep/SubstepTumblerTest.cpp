// Tests a moving heap in a rotating drum.

#include <algorithm>

#include "SubstepScene.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr double kHalf = 0.125;  // half the width of a box
constexpr double kRadius = 6;    // distance of the middle of each wall from the drum's centre
constexpr double kDrumTurn = 0.05 * 2 * std::numbers::pi / 30;  // rad per tick: a revolution in 20 s

// Adds a square drum as body 0, which rotates about the origin.
void addDrum(SubstepScene& scene) {
  std::vector<ConvexShape> walls(4);
  makeBox(kRadius + 0.5, 0.5, {0, kRadius}, {}, 0, walls[0]);
  makeBox(kRadius + 0.5, 0.5, {0, -kRadius}, {}, 0, walls[1]);
  makeBox(0.5, kRadius + 0.5, {kRadius, 0}, {}, 0, walls[2]);
  makeBox(0.5, kRadius + 0.5, {-kRadius, 0}, {}, 0, walls[3]);
  RigidBody drum = immovable({});
  drum.spin = kDrumTurn;
  scene.world.addInOrder(++scene.order, drum, walls);
}

TEST(SubstepTumbler, TurningDrumKeepsItsBoxesInside) {
  SubstepOptions options = awake();
  options.searches = 2, options.substeps = 5;  // as at ACCURACY_DEFAULT
  SubstepScene scene(options);
  addDrum(scene);
  constexpr int kBoxes = 150;
  for (int i = 0; i < kBoxes; ++i) {
    scene.addCrate({0.35 * (i % 15 - 7), 0.35 * (i / 15 - 5)}, kHalf);
  }
  double deepest = 0, sum = 0, fastest = 0;
  constexpr int kTicks = 240, kFallen = 40;
  for (int tick = 0; tick < kTicks; ++tick) {
    scene.ticks(1);
    for (int id = 1; id <= kBoxes; ++id) {
      fastest = std::max(fastest, scene.speed(id));
      const Vec2 inside = inverse(scene.world.body(0).rotation) * scene.at(id);
      ASSERT_LT(std::max(std::fabs(inside.x), std::fabs(inside.y)), kRadius) << id << ' ' << tick;
    }
    if (tick < kFallen) continue;
    deepest = std::max(deepest, scene.world.deepest());
    sum += scene.world.deepest();
  }
  EXPECT_LT(deepest, 0.3 * 2 * kHalf);  // like Box2D with four times the steps: 0.076 of 0.25
  EXPECT_LT(sum / (kTicks - kFallen), 0.1 * 2 * kHalf);
  EXPECT_LT(fastest, std::sqrt(2 * kGravityPerTick * 4 * kRadius));  // no box is thrown
}

}  // namespace
}  // namespace naiad::physics
