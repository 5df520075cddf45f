#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/bench/physics/Overlap.h"
#include "tests/bench/physics/Run.h"
#include "tests/bench/physics/Scenes.h"

namespace bench::physics {
namespace {

std::vector<Pose> startOf(const Scene& scene) {
  std::vector<Pose> poses;
  for (const Body& body : scene.bodies) poses.push_back({body.x, body.y});
  return poses;
}

void expectStart(const Scene& scene, int dynamic, std::size_t hinges) {
  EXPECT_EQ(scene.countDynamic(), dynamic);
  EXPECT_EQ(scene.hinges.size(), hinges);
  EXPECT_EQ(widestHinge(scene, startOf(scene)), 0);
  if (scene.collide) {
    EXPECT_LT(deepestOverlap(scene.bodies, startOf(scene)), 1e-9);
  }
}

TEST(Scenes, StartWithoutOverlap) {
  expectStart(makePyramid60(), 1830, 0);
  expectStart(makePyramids100(), 5500, 0);
  expectStart(makeTumbler500(), 500, 0);
  expectStart(makeHeap2000(), 2000, 0);
  expectStart(makeHeap20000(), 20'000, 0);
  expectStart(makeSmash(), 2401, 0);
  expectStart(makeChain100(), 21, 21);
  expectStart(makeGrid100(), 9993, 19'800);
}

TEST(Scenes, ChainLoadWeighsAHundredLinks) {
  const Scene scene = makeChain100();
  EXPECT_DOUBLE_EQ(scene.bodies.back().mass(), 100 * scene.bodies.front().mass());
}

// Moves one body as the test specifies.
class Scripted : public Simulation {
 public:
  explicit Scripted(const Scene& scene) : poses(startOf(scene)) {}
  void tick() override { poses.back().y += fall; }
  Pose pose(std::size_t body) const override { return poses[body]; }
  bool isFrozen(std::size_t body) const override { return static_cast<int>(body) == frozen; }

  std::vector<Pose> poses;
  double fall = 0;
  int frozen = -1;
};

Scene boxOverFloor() {
  Scene scene = makePyramid60();
  scene.bodies.resize(2);
  scene.bodies.back().y = -0.5;
  scene.ticks = 25;
  return scene;
}

TEST(Run, SamplesOverlapEveryTenTicks) {
  const Scene scene = boxOverFloor();
  Scripted simulation(scene);
  simulation.fall = 0.01;
  const auto result = run(scene, simulation, 1000);
  EXPECT_EQ(result.tick_ms.size(), 25u);
  EXPECT_EQ(result.looks, 2);
  EXPECT_NEAR(result.meanOverlap(), 0.15, 1e-9);
  EXPECT_EQ(result.failed, 0);
  EXPECT_FALSE(result.cut);
}

TEST(Run, CountsTunnelledFrozenAndNonFiniteBodies) {
  const Scene scene = boxOverFloor();
  Scripted sinking(scene), frozen(scene), lost(scene), dizzy(scene);
  sinking.fall = 0.021;  // its centre is in the floor only at the end
  frozen.frozen = 1;
  lost.fall = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(run(scene, sinking, 1000).failed, 1);
  EXPECT_EQ(run(scene, frozen, 1000).failed, 1);
  dizzy.poses.back().sine = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(run(scene, lost, 1000).failed, 1);
  EXPECT_EQ(run(scene, dizzy, 1000).failed, 1);
}

TEST(Run, ChecksTheDrumInItsRotatedFrame) {
  Scene scene = makeTumbler500();
  scene.bodies.resize(2);
  Scripted simulation(scene);
  const double eighth = std::sqrt(0.5);
  simulation.poses = {{0, 0, eighth, eighth}, {9, 9}};
  EXPECT_EQ(run(scene, simulation, 1000).failed, 1);
  simulation.poses[1] = {9, -9};
  EXPECT_EQ(run(scene, simulation, 1000).failed, 1);
  simulation.poses[1] = {12, 0};
  EXPECT_EQ(run(scene, simulation, 1000).failed, 0);
}

TEST(Run, StopsAtTheTimeLimit) {
  const Scene scene = boxOverFloor();
  Scripted simulation(scene);
  const auto result = run(scene, simulation, -1);
  EXPECT_EQ(result.tick_ms.size(), 1u);
  EXPECT_TRUE(result.cut);
}

}  // namespace
}  // namespace bench::physics
