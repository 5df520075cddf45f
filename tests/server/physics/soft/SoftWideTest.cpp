// Bodies that are too wide for a direct solution (SoftElastic.h).

#include <random>

#include "SoftScene.h"
#include "physics/numerics/ConjugateGradients.h"
#include "physics/soft/SoftElastic.h"
#include "tests/server/physics/BitHash.h"
#include "tests/support/Sanitizers.h"

namespace naiad::physics {
namespace {

using test::kBody;

constexpr double kPull = 0.04;  // cells per tick²: 0.02 rows

SoftBody makeSheet(int threads, double mesh, double stiffness = 5) {
  const double width = mesh * (threads - 1);
  SoftBody sheet = makeCloth(placeAt({0, 0}), {width, 0}, {0, width}, threads - 1, threads - 1, 1,
                             stiffness / threads, stiffness / threads / 4, 0);
  for (SoftStretch& s : sheet.stretches) s.limit = s.rest_length < 1.01 * mesh ? 0.03 : 0;
  sheet.friction = 0.5;
  sheet.drag = 0.02;
  return sheet;
}

void pinCorners(SoftBody& sheet, int threads) {
  sheet.nodes[0].is_pinned = true;
  sheet.nodes[at(threads * (threads - 1))].is_pinned = true;
}

double stretchOf(const SoftBody& body) {
  double most = 0;
  for (const SoftStretch& s : body.stretches) {
    if (s.limit == 0) continue;
    const double far = length(body.nodes[at(s.b)].offset - body.nodes[at(s.a)].offset);
    most = std::max(most, far / s.rest_length - 1);
  }
  return most;
}

TEST(SoftWide, ConjugateGradientsSolveTheSystem) {
  std::mt19937 random(7);
  const auto number = [&random] { return static_cast<double>(random() % 1000) / 1000; };
  constexpr int kNodes = 60;
  std::vector<ConjugateGradients::Pair> pairs;
  for (int i = 0; i + 1 < kNodes; ++i) pairs.push_back({i, i + 1});
  for (int i = 0; i + 9 < kNodes; ++i) pairs.push_back({i + 9, i});
  ConjugateGradients system;
  system.resize(kNodes, pairs);
  system.clear(100);
  std::vector<double> truth, rows(2 * kNodes, 0.0);
  for (int i = 0; i < 2 * kNodes; ++i) truth.push_back(number() - 0.5);
  const auto add = [&](int i, int j, double xx, double xy, double yx, double yy) {
    rows[at(2 * i)] += xx * truth[at(2 * j)] + xy * truth[at(2 * j + 1)];
    rows[at(2 * i + 1)] += yx * truth[at(2 * j)] + yy * truth[at(2 * j + 1)];
  };
  for (int i = 0; i < kNodes; ++i) {
    system.addDiagonal(i, {300, 10, 250});
    add(i, i, 300, 10, 10, 250);
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ConjugateGradients::Block block = {-40 * number(), 5 * number(), -30 * number()};
    system.addPair(static_cast<int>(k), block);
    add(pairs[k].a, pairs[k].b, block.xx, block.xy, block.xy, block.yy);
    add(pairs[k].b, pairs[k].a, block.xx, block.xy, block.xy, block.yy);
  }
  EXPECT_GT(system.solve(rows, 100, 1e-5), 3);
  for (int i = 0; i < 2 * kNodes; ++i) EXPECT_NEAR(rows[at(i)], truth[at(i)], 1e-4) << i;
}

// Their cost grows with the number of nodes, because their iterations are bounded.
TEST(SoftWide, OnlyExpensiveBodiesAreSolvedIteratively) {
  SoftElastic elastic;
  const auto isWide = [&](SoftBody body) {
    elastic.prepare(body);
    return elastic.isWide();
  };
  EXPECT_FALSE(isWide(makeRope(placeAt({}), {99, 0}, 2000, 1, 5)));
  for (int threads = 12; threads <= 64; ++threads)
    EXPECT_EQ(isWide(makeSheet(threads, 0.5)), threads >= 20) << threads;
}

TEST(SoftWide, PinnedSheetStretchesByAtMostFivePercent) {
  constexpr int kThreads = naiad::test::kSanitized ? 40 : 100;  // with a sanitizer, 100 threads would take
                                                                // minutes
  SoftBody sheet = makeSheet(kThreads, 0.4);
  pinCorners(sheet, kThreads);
  SoftWorld world = test::worldWith(sheet, kPull);
  const double start = energyOf(world.body(kBody), {0, kPull});
  for (int i = 0; i < 300; ++i) {
    world.step();
    const SoftBody& body = world.body(kBody);
    ASSERT_LE(stretchOf(body), 0.05) << i;  // false if it is NaN, too
    ASSERT_LE(energyOf(body, {0, kPull}), start + 1e-6 * std::fabs(start)) << i;
    ASSERT_EQ(test::nodeAt(world, kBody, 0), Vec2{}) << i;
  }
  EXPECT_EQ(world.counters().quarantined, 0);
  EXPECT_LE(test::fastest(world.body(kBody)), 0.5);
}

TEST(SoftWide, MomentumIsConservedToRounding) {
  constexpr int kThreads = 32;
  SoftBody sheet = makeSheet(kThreads, 0.5);
  sheet.drag = 0;
  for (std::size_t i = 0; i < sheet.nodes.size(); ++i) {
    sheet.nodes[i].velocity = {0.1 * static_cast<double>(i % 7), 0.02 * static_cast<double>(i % 11)};
  }
  SoftWorld world = test::worldWith(sheet);
  const Vec2 before = test::momentumOf(world.body(kBody));
  const double energy = energyOf(world.body(kBody), {});
  for (int i = 0; i < 100; ++i) {
    world.step();
    ASSERT_LE(length(test::momentumOf(world.body(kBody)) - before), 1e-13 * (i + 1)) << i;
    ASSERT_LE(energyOf(world.body(kBody), {}), energy * (1 + 1e-6)) << i;
  }
}

TEST(SoftWide, FallingSheetPutsNoNodeInTheBox) {
  constexpr int kThreads = 60;
  SoftWorld world = test::worldWith(makeSheet(kThreads, 0.5), kPull);
  const ConvexShape shape = test::boxShape(5, 3);
  SoftObstacle box[] = {test::obstacleAt(0, shape, {14.75, 34}, 0.5)};
  int begun = 0;
  constexpr int kTicks = naiad::test::kSanitized ? 50 : 150;  // the sheet reaches the box in the 20th tick
  for (int i = 0; i < kTicks; ++i) {
    world.step(1, box);
    for (const SoftEvent& event : world.events()) begun += event.is_begin ? 1 : 0;
    for (std::size_t k = 0; k < world.body(kBody).nodes.size(); ++k) {
      const Vec2 there = test::nodeAt(world, kBody, static_cast<int>(k)) - Vec2{14.75, 34};
      ASSERT_FALSE(std::fabs(there.x) < 5 - 1e-9 && std::fabs(there.y) < 3 - 1e-9) << i << ": node " << k;
    }
  }
  EXPECT_GE(begun, 1);
  EXPECT_EQ(world.counters().quarantined, 0);
}

TEST(SoftWide, SheetCarriesAMovableBox) {
  constexpr int kThreads = 40;
  SoftBody sheet = makeSheet(kThreads, 0.5, 200);
  for (int j = 0; j < kThreads; ++j) {
    sheet.nodes[at(j)].is_pinned = sheet.nodes[at(j + kThreads * (kThreads - 1))].is_pinned = true;
  }
  SoftWorld world = test::worldWith(sheet, kPull);
  const ConvexShape shape = test::boxShape(1, 1);
  SoftObstacle crate = test::obstacleAt(3, shape, {9.75, -1.3}, 0.5);
  crate.inverse_mass = 1;
  crate.acceleration = {0, kPull};
  test::stepWith(world, crate, 300);
  EXPECT_TRUE(world.isTouching(kBody, 3));
  EXPECT_LT(std::fabs(crate.velocity.y), 0.02);
  EXPECT_LT((crate.place - Place{}).y, 5);
}

TEST(SoftWide, AnAttachedNodeFollowsItsObstacle) {
  constexpr int kThreads = 30;
  SoftWorld world = test::worldWith(makeSheet(kThreads, 0.5), kPull);
  SoftObstacle hook;
  hook.id = 5;
  hook.velocity = {0.05, 0};
  world.attach({kBody, 0, 5, {}});
  for (int i = 0; i < 100; ++i) {
    test::stepWith(world, hook);
    ASSERT_LE(length(test::nodeAt(world, kBody, 0) - (hook.place - Place{})), 0.05) << i;
  }
}

TEST(SoftWide, PinsHoldUntilReleased) {
  constexpr int kThreads = 30;
  SoftWorld world = test::worldWith(makeSheet(kThreads, 0.5), kPull);
  for (int i = 0; i < 20; ++i) world.step();
  ASSERT_TRUE(world.pin(kBody, 0, true));
  const Vec2 held = test::nodeAt(world, kBody, 0);
  for (int i = 0; i < 50; ++i) world.step();
  EXPECT_EQ(test::nodeAt(world, kBody, 0), held);
  ASSERT_TRUE(world.pin(kBody, 0, false));
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_GT(test::nodeAt(world, kBody, 0).y, held.y + 1);
  EXPECT_FALSE(world.pin(kBody, kThreads * kThreads, true));
}

TEST(SoftWide, GainsNoEnergyAtAnyStiffnessAndMass) {
  for (const double stiffness : {1e-6, 1.0, 1e6}) {
    for (const double mass : {1e-6, 1e6}) {
      SoftBody sheet = makeSheet(30, 0.1, stiffness);
      for (SoftNode& node : sheet.nodes) node.mass *= mass;
      for (SoftStretch& s : sheet.stretches) s.stiffness *= mass;
      pinCorners(sheet, 30);
      SoftWorld world = test::worldWith(sheet, kPull);
      const double start = energyOf(world.body(kBody), {0, kPull});
      for (int i = 0; i < 60; ++i) world.step();
      const double end = energyOf(world.body(kBody), {0, kPull});
      EXPECT_LE(end, start + 1e-6 * std::fabs(start)) << stiffness << " " << mass;
      EXPECT_EQ(world.counters().quarantined, 0) << stiffness << " " << mass;
    }
  }
}

// For the stiffest cloth, iterations with an earlier decomposition do not always converge. This costs at most
// one iteration per sub-step: in all 4 % more than a decomposition for each iteration.
TEST(SoftWide, DefaultClothReusesItsDecompositionWhileItConverges) {
  for (const double stiffness : {5.0, 5e10}) {
    SoftBody sheet = makeSheet(19, 0.1, stiffness);
    for (SoftStretch& s : sheet.stretches) s.limit = 0;
    sheet.nodes[18 * 19].is_pinned = true;
    sheet.nodes[180].velocity = {0.5, 0.3};
    const double start = energyOf(sheet, {0, kPull});
    SoftWorld world = test::worldWith(sheet, kPull);
    for (int i = 0; i < 60; ++i) world.step(5);
    const SoftCounters& done = world.counters();
    EXPECT_LE(done.iterations, stiffness > 1e9 ? 4200 : 6100) << stiffness;
    EXPECT_LE(done.decompositions, 2500) << stiffness;
    EXPECT_EQ(done.unconverged, 0) << stiffness;
    EXPECT_LE(energyOf(world.body(kBody), {0, kPull}), start + 1e-9 * std::fabs(start)) << stiffness;
  }
}

// Returns a hash of a sheet that hangs by two corners over a box, after 100 ticks.
std::uint64_t hashOfSheet(int threads, bool& has_touched) {
  SoftBody sheet = makeSheet(threads, 0.5);
  if (threads < 20) {
    for (SoftStretch& s : sheet.stretches) s.limit = 0;
  }
  pinCorners(sheet, threads);
  SoftWorld world = test::worldWith(sheet, kPull);
  const double width = 0.5 * (threads - 1);
  const ConvexShape shape = test::boxShape(3, 3);
  SoftObstacle box[] = {test::obstacleAt(0, shape, {width / 2, width + 3.3}, 0.5)};
  for (int i = 0; i < 100; ++i) {
    world.step(1, box);
    has_touched = has_touched || world.isTouching(kBody, 0);
  }
  test::BitHash hash;
  for (const SoftNode& node : world.body(kBody).nodes) hash.add(node.offset), hash.add(node.velocity);
  return hash.value();
}

// The hashes are equal for every compiler.
TEST(SoftWide, SheetHashesAreTheSameOnEveryPlatform) {
  for (const auto& [threads, hash] : {std::pair{30, 0x430d960ec7c94411u}, {19, 12852063627060927655u}}) {
    bool has_touched = false;
    EXPECT_EQ(hashOfSheet(threads, has_touched), hash) << threads;
    EXPECT_TRUE(has_touched) << threads;
  }
}

}  // namespace
}  // namespace naiad::physics
