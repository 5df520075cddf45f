#include "SoftScene.h"
#include "tests/server/physics/RandomShapes.h"
#include "tests/support/Sanitizers.h"

namespace naiad::physics {
namespace {

using test::kBody;
using test::kGravity;

SoftBody softBlob(Vec2 at, double friction = 0.5) {
  SoftBody blob = makeBlob(placeAt(at), 2, 24, 10, 0.05, 0.2, 0.5, 0.01);
  blob.friction = friction;
  blob.drag = 0.02;
  for (SoftStretch& s : blob.stretches) s.damping = 0.02;
  return blob;
}
double lowest(const SoftWorld& world, int id) {
  double most = -1e300;
  for (const SoftNode& node : world.body(id).nodes) most = std::max(most, node.offset.y);
  return (world.body(id).place - Place{}).y + most;
}

TEST(SoftContact, FloorBearsTheBlobsWeight) {
  const ConvexShape slab = test::boxShape(20, 1);
  SoftObstacle floor = test::obstacleAt(7, slab, {0, 1}, 0.5);
  SoftWorld world = test::worldWith(softBlob({0, -3}), kGravity);
  int begun = 0;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_EQ(world.step(1, {&floor, 1}), SoftStatus::kDone);
    for (const SoftEvent& event : world.events()) {
      begun += event.is_begin ? 1 : 0;
      EXPECT_EQ(event.body, kBody);
      EXPECT_EQ(event.other, 7);
      EXPECT_FALSE(event.is_other_soft);
      EXPECT_GT(event.impulse, 0);
    }
  }
  EXPECT_EQ(begun, 1);
  EXPECT_NEAR(lowest(world, kBody), -world.body(kBody).radius, 1e-6);
  EXPECT_NEAR(floor.impulse.y / (10 * kGravity), 1, 1e-3);
  EXPECT_LT(test::fastest(world.body(kBody)), 1e-4);
}

TEST(SoftContact, BlobRestsOnAnotherBlob) {
  const ConvexShape slab = test::boxShape(20, 1), wall = test::boxShape(1, 20);
  SoftObstacle box[] = {test::obstacleAt(0, slab, {0, 1}, 0.5), test::obstacleAt(1, wall, {-3.6, 0}, 0.5),
                        test::obstacleAt(2, wall, {3.6, 0}, 0.5)};
  SoftWorld world;
  world.setGravity({0, kGravity});
  const int lower = world.add(softBlob({0, -2.2})), upper = world.add(softBlob({0.2, -7}));
  for (int i = 0; i < 1200; ++i) world.step(1, box);
  EXPECT_NEAR((box[0].impulse.y + box[1].impulse.y + box[2].impulse.y) / (20 * kGravity), 1, 0.01);
  EXPECT_GT(test::centreOf(world, lower).y - test::centreOf(world, upper).y, 2);
  EXPECT_LT(test::fastest(world.body(upper)), 1e-2);
  // No node of one blob is inside the other.
  for (int i = 0; i < 24; ++i) {
    EXPECT_GT(length(test::nodeAt(world, upper, i) - test::centreOf(world, lower)), 1);
  }
}

// A crate of any weight lies on a rope between two pins, which carries exactly that weight.
TEST(SoftContact, CrateLiesOnARopeBridge) {
  const ConvexShape cube = test::boxShape(1, 1);
  for (const double mass : {4.0, 40.0, 400.0}) {
    SoftBody rope = makeRope(placeAt({-6, 0}), {12, 0}, 16, 4, 1000);
    rope.nodes.front().is_pinned = rope.nodes.back().is_pinned = true;
    rope.friction = 0.5;
    rope.drag = 0.02;
    SoftWorld world = test::worldWith(rope, kGravity);
    SoftObstacle crate = test::crateAt(3, cube, {0.2, -1.5}, mass, 1.5);
    test::stepWith(world, crate, 1500);
    EXPECT_NEAR(-crate.impulse.y / (mass * kGravity), 1, 1e-2) << mass;
    EXPECT_LT(length(crate.velocity), 1e-2) << mass;
    EXPECT_LT((crate.place - Place{}).y + 1, test::nodeAt(world, kBody, 8).y + 0.1) << mass;
    EXPECT_LT(std::fabs(angleOf(crate.rotation)), 0.1) << mass;
  }
}

// The momentum that the blob loses is that which the crate gains.
TEST(SoftContact, SoftRigidContactConservesMomentum) {
  const ConvexShape cube = test::boxShape(1, 1);
  SoftBody blob = softBlob({-4, 0.3});
  blob.drag = 0;
  for (SoftNode& node : blob.nodes) node.velocity = {0.4, 0};
  SoftWorld world = test::worldWith(blob);
  SoftObstacle crate = test::obstacleAt(3, cube, {0, 0}, 0.5);
  crate.inverse_mass = 1 / 7.0;
  crate.inverse_inertia = 1.5 / 7;
  const Vec2 before = test::momentumOf(world.body(kBody));
  const auto twist = [&] {  // angular momentum about the origin
    double sum = 7 / 1.5 * crate.spin + 7 * cross(crate.place - Place{}, crate.velocity);
    for (int i = 0; i < 24; ++i) {
      const SoftNode& node = world.body(kBody).nodes[static_cast<std::size_t>(i)];
      sum += node.mass * cross(test::nodeAt(world, kBody, i), node.velocity);
    }
    return sum;
  };
  const double twist_before = twist();
  test::stepWith(world, crate, 100);
  EXPECT_GT(crate.velocity.x, 0.05);
  EXPECT_LT(length(test::momentumOf(world.body(kBody)) + 7 * crate.velocity - before) / length(before), 1e-9);
  EXPECT_GT(std::fabs(crate.spin), 1e-4);
  EXPECT_NEAR(twist() / twist_before, 1, 0.02) << crate.spin;
}

// A soft slab lies on a slope. Friction holds it up to its angle; above, it slides with g (sin θ − µ cos θ).
TEST(SoftContact, FrictionHoldsAndSlides) {
  const ConvexShape slab = test::boxShape(200, 1);
  for (const double slope : {0.45, 0.6}) {
    SoftObstacle floor = test::obstacleAt(0, slab, {0, 1}, 0.5);
    SoftBody block = makeCloth(placeAt({0, -1.3}), {4, 0}, {0, 1}, 8, 2, 4, 50, 50, 0);
    block.friction = 0.5;
    for (SoftStretch& s : block.stretches) s.damping = 1;
    SoftWorld world;
    const double angle = std::atan(slope);
    world.setGravity({kGravity * std::sin(angle), kGravity * std::cos(angle)});
    const int id = world.add(block);
    for (int i = 0; i < 100; ++i) world.step(1, {&floor, 1});
    const double speed = test::momentumOf(world.body(id)).x / 4;
    for (int i = 0; i < 100; ++i) world.step(1, {&floor, 1});
    const double gained = (test::momentumOf(world.body(id)).x / 4 - speed) / 100;
    const double expected = std::max(0.0, kGravity * (std::sin(angle) - 0.5 * std::cos(angle)));
    EXPECT_NEAR(gained, expected, 1e-2 * kGravity) << slope;
    if (slope < 0.5) {
      EXPECT_LT(std::fabs(speed), 1e-3);
    }
  }
}

// Problem 14 of docs/physics/lab.md: no node passes through a wall, at 1e6 cells per second and more.
TEST(SoftContact, NoNodePassesAWall) {
  SplitMix64 random(5);
  constexpr int kShots = 1000 / naiad::test::kShare;
  for (int i = 0; i < kShots; ++i) {
    const double speed = std::pow(10, test::between(random, -1, 5));
    const ConvexShape wall = test::boxShape(0.02, 60);
    SoftObstacle obstacle = test::obstacleAt(1, wall, {5, 0});
    obstacle.velocity = {i % 3 == 0 ? -test::between(random, 0, 1) * speed : 0, 0};
    obstacle.place = obstacle.place + Vec2{-2 * obstacle.velocity.x, 0};
    SoftBody body =
        i % 2 == 0 ? makeBlob({}, 1, 16, 1, 0.05, 0.2, 0.5, 0.01)
                   : makeRope(placeAt({-1, -2}), {0, 4}, 12, 1, std::pow(10, test::between(random, -1, 8)));
    for (SoftNode& node : body.nodes) node.velocity = {speed * test::between(random, 0.5, 1), 0};
    SoftWorld world = test::worldWith(body);
    for (int tick = 0; tick < 12; ++tick) {
      ASSERT_EQ(world.step(1, {&obstacle, 1}), SoftStatus::kDone);
      test::advance(obstacle);
      const double x = (obstacle.place - Place{}).x;
      for (int node = 0; node < static_cast<int>(body.nodes.size()); ++node) {
        const Vec2 at = test::nodeAt(world, kBody, node);
        if (std::fabs(at.y) < 59) {
          ASSERT_LT(at.x, x + 1e-9 * speed) << i << ' ' << speed;
        }
      }
    }
  }
}

// A crate hangs on one end of a rope, and the other end holds both.
TEST(SoftContact, CrateHangsOnARope) {
  const ConvexShape cube = test::boxShape(0.5, 0.5);
  SoftBody rope = makeRope({}, {0, 5}, 10, 1, 1e4);
  rope.nodes[0].is_pinned = true;
  SoftWorld world = test::worldWith(rope, kGravity);
  SoftObstacle crate = test::crateAt(3, cube, {0.5, 5.4}, 10, 6, 0);
  const int held = world.attach({kBody, 10, 3, {0, -0.5}});
  ASSERT_GE(held, 0);
  for (int i = 0; i < 300; ++i) {
    test::stepWith(world, crate);
    const Vec2 anchor = (crate.place - Place{}) + crate.rotation * Vec2{0, -0.5};
    ASSERT_LT(length(anchor - test::nodeAt(world, kBody, 10)), i < 10 ? 0.12 : 5e-3) << i;
    crate.velocity *= 0.97;
    crate.spin *= 0.97;
  }
  EXPECT_NEAR(-crate.impulse.y / (10 * kGravity), 1, 0.05);
  ASSERT_TRUE(world.detach(held));
  test::stepWith(world, crate, 60);
  EXPECT_GT((crate.place - Place{}).y, 10);
}

}  // namespace
}  // namespace naiad::physics
