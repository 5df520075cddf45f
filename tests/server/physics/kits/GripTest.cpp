#include <optional>

#include "physics/body/SoftObject.h"
#include "physics/kits/Grip.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

using Grips = BodyScene;

double apart(Vector a, Vector b) {
  return (a - b).getMagnitude();
}

TEST_F(Grips, GrabbedBodyFollowsAndKeepsItsVelocity) {
  Body* p_crate = crate(Vector(3, 4));
  Grip grip;
  EXPECT_FALSE(grip.isHolding());
  ASSERT_EQ(grip.grab(Vector(3, 4)), 0);
  EXPECT_TRUE(grip.isHolding());
  for (int i = 1; i <= 40; ++i) {
    EXPECT_EQ(grip.dragTo(Vector(3 + 0.2 * i, 4)), 0);
    ticks(1);
  }
  EXPECT_LT(apart(p_crate->getPosition(), Vector(11, 4)), 0.5);
  grip.release();
  EXPECT_FALSE(grip.isHolding());
  EXPECT_EQ(grip.dragTo(Vector(0, 0)), -1);
  const Vector velocity = p_crate->getVelocity();
  EXPECT_NEAR(velocity.x(), 0.2, 0.1);
  ticks(10);
  EXPECT_EQ(p_crate->getVelocity(), velocity);
}

TEST_F(Grips, GrabbedSoftBodyFollows) {
  auto* p_blob = new Blob(Vector(3, 4), 2);
  Grip grip;
  ASSERT_EQ(grip.grab(Vector(3, 4)), 0);
  EXPECT_TRUE(p_blob->isGrabbed());
  grip.dragTo(Vector(10, 6));
  ticks(200);
  EXPECT_LT(apart(p_blob->getNodePosition(p_blob->getNearestNode(Vector(10, 6))), Vector(10, 6)), 0.2);
  grip.release();
  EXPECT_FALSE(p_blob->isGrabbed());
}

// The grip's force is proportional to the mass.
TEST_F(Grips, HeavyAndLightBodiesFollowEquallyFast) {
  double gone[2] = {};
  for (int i = 0; i < 2; ++i) {
    Body* p_crate = crate(Vector(0, 100.0 * i), Vector(0.5, 0.5), i == 0 ? 1 : 1000);
    Grip grip;
    ASSERT_EQ(grip.grab(Vector(0, 100.0 * i), 0.01), 0);
    grip.dragTo(Vector(50, 100.0 * i));
    ticks(20);
    gone[i] = p_crate->getPosition().x();
  }
  EXPECT_NEAR(gone[0], 0.01 * 20 * 20 / 2, 0.2);
  EXPECT_NEAR(gone[1], gone[0], 1e-6);
}

TEST_F(Grips, GrabFailsWithoutAFreeBody) {
  new Blob(Vector(3, 4), 2);
  wall(Vector(20, 20), Vector(1, 1));
  Grip mine, yours;
  EXPECT_EQ(mine.grab(Vector(40, 40)), -1);
  EXPECT_EQ(mine.grab(Vector(20, 20)), -1);  // a wall is there, which is not a body
  EXPECT_EQ(mine.grab(Vector(kNan, 0)), -1);
  EXPECT_EQ(mine.grab(Vector(3, 4), kNan), -1);
  EXPECT_FALSE(mine.isHolding());
  ASSERT_EQ(mine.grab(Vector(3, 4)), 0);
  EXPECT_EQ(yours.grab(Vector(3, 4)), -1);
  mine.release();
  EXPECT_EQ(yours.grab(Vector(3, 4)), 0);
}

TEST_F(Grips, GripEndsWithItsBodyOrItself) {
  Body* p_crate = crate(Vector(3, 4));
  auto* p_blob = new Blob(Vector(20, 4), 2);
  Grip one;
  ASSERT_EQ(one.grab(Vector(3, 4)), 0);
  delete p_crate;
  EXPECT_FALSE(one.isHolding());
  ASSERT_EQ(one.grab(Vector(20, 4)), 0);
  delete p_blob;
  EXPECT_FALSE(one.isHolding());
  EXPECT_EQ(one.dragTo(Vector(0, 0)), -1);
  auto* p_other = new Blob(Vector(20, 4), 2);
  crate(Vector(3, 4));
  {
    Grip two, three;
    ASSERT_EQ(two.grab(Vector(20, 4)), 0);
    ASSERT_EQ(three.grab(Vector(3, 4)), 0);
    EXPECT_EQ(PM.getJointCount(), 1);
  }
  EXPECT_FALSE(p_other->isGrabbed());
  EXPECT_EQ(PM.getJointCount(), 0);
}

TEST(Grip, MayOutliveTheWorld) {
  std::optional<Grip> body, soft;
  {
    const OwnWorld gone;
    BodyScene::crate(Vector(3, 4));
    new Blob(Vector(20, 4), 2);
    ASSERT_EQ(body.emplace().grab(Vector(3, 4)), 0);
    ASSERT_EQ(soft.emplace().grab(Vector(20, 4)), 0);
  }
  EXPECT_FALSE(body->isHolding());
  EXPECT_FALSE(soft->isHolding());
  body.reset(), soft.reset();
}

}  // namespace
}  // namespace df::test
