// Bodies created in one place at the fast level: the work is limited, and the bodies separate.

#include <algorithm>

#include "SubstepScene.h"
#include "shared/values/SplitMix64.h"

namespace naiad::physics {
namespace {

using namespace test;

// Makes discs of radius `least` to 0.5.
SubstepScene crowd(int count, double spread, double least = 0.5, std::uint64_t seed = 29) {
  SplitMix64 random(seed);
  SubstepScene scene(awake());
  for (int i = 0; i < count; ++i) {
    const ConvexShape disc = circleShape(least < 0.5 ? least + (0.5 - least) * random.unit() : 0.5);
    const double x = spread * random.unit(), y = spread * random.unit();
    scene.add(floating({x, y}, disc), disc);
  }
  return scene;
}

// The bodies become fast when they are pushed, and pass through each other. Of different sizes, each has
// contacts only with the nearest of the larger ones, too. `contacts` and `near` are limits for a body and
// tick; few others are near once it is not thinned.
TEST(SubstepCrowd, WorkGrowsWithBodiesNotPairs) {
  const struct {
    double spread, least;
    std::uint64_t seed;
    int ticks, contacts, near;
  } kCases[] = {
      {1, 0.5, 29, 20, 16 + 2, 64}, {0, 0.5, 29, 20, 16 + 2, 64}, {1, 0.05, 31, 10, 2 * 16 + 2, 128}};
  for (const auto& its : kCases) {
    for (const int count : {500, 2000}) {
      SCOPED_TRACE(testing::Message() << its.spread << ' ' << its.least << ' ' << count);
      SubstepScene scene = crowd(count, its.spread, its.least, its.seed);
      SubstepCounters before;
      for (int tick = 0; tick < its.ticks; ++tick) {
        scene.ticks(1);
        const SubstepCounters& now = scene.world.counters();
        EXPECT_LE(now.contacts - before.contacts, its.contacts * count) << tick;
        EXPECT_LE(now.near - before.near, its.near * count) << tick;
        before = now;
      }
      EXPECT_TRUE(scene.world.hasThinned());
      EXPECT_EQ(before.quarantined, 0);
    }
  }
}

TEST(SubstepCrowd, OverlappingBodiesComeApart) {
  SubstepScene scene = crowd(1000, 1);
  scene.ticks(120);
  EXPECT_LT(scene.world.deepest(), 0.05);
  double fastest = 0;
  for (int id = 0; id < scene.world.idLimit(); ++id) fastest = std::max(fastest, scene.speed(id));
  EXPECT_LT(fastest, 3);
}

// A fast body that is not part of a crowd is stopped by the crowd.
TEST(SubstepCrowd, FastBodyStopsAtTheCrowd) {
  SubstepScene scene = crowd(300, 1);
  const ConvexShape disc = circleShape(0.5);
  const int id = scene.add(floating({-30, 0.5}, disc, {40, 0}, 50), disc);
  scene.ticks(1);
  EXPECT_GT(scene.world.counters().near, 0);
  EXPECT_TRUE(scene.world.isStopped(id));
}

// The body that leaves finds few younger ones, so its pairs are not limited, unlike those of the bodies
// around it.
TEST(SubstepCrowd, BodyInsideACrowdCanLeaveIt) {
  SubstepScene scene = crowd(300, 0.3);
  const ConvexShape disc = circleShape(0.5);
  for (int i = 0; i < 40; ++i) scene.add(floating({0.007 * i, -0.5}, disc), disc);
  const int leaving = scene.add(floating({0.6, 0.55}, disc, {-40, 0}), disc);
  scene.ticks(1);
  EXPECT_FALSE(scene.world.isStopped(leaving));
  EXPECT_GT(length(scene.at(leaving)), 5);
}

// A heavy body stays where the crowd was. Another crowd that flies towards it does not pass through it.
TEST(SubstepCrowd, RemainingBodyOfACrowdStopsAnotherCrowd) {
  SubstepScene scene(awake());
  const ConvexShape disc = circleShape(0.5);
  SplitMix64 random(3);
  const int heavy = scene.add(floating({}, disc, {}, 1e9), disc);
  for (int i = 0; i < 100; ++i) {
    const double x = random.unit() - 0.5, y = random.unit() - 0.5;
    scene.add(floating({x, y}, disc), disc);
  }
  scene.ticks(100);
  ASSERT_LT(length(scene.at(heavy)), 0.1);
  std::vector<int> flying;
  for (int i = 0; i < 100; ++i) {
    flying.push_back(scene.add(floating({-3, 0.002 * i - 0.1}, disc, {40, 0}), disc));
  }
  scene.ticks(1);
  EXPECT_EQ(std::count_if(flying.begin(), flying.end(), [&](int id) { return scene.at(id).x > 0; }), 0);
}

}  // namespace
}  // namespace naiad::physics
