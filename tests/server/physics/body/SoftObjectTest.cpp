// Soft bodies as Objects: rest, events, Objects that lie or hang on them, stiffness and drawing.
#include <algorithm>

#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "physics/body/SoftLayer.h"
#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df {
namespace {

class SoftObjects : public test::PhysicsWorld {
 protected:
  SoftObjects() { PM.setGravity(Vector(0, 0.02)); }

  /// Makes a rope between two pins, 20 cells long.
  static Rope* bridge() {
    auto* p_rope = new Rope(Vector(10, 10), Vector(30, 10), 1, 50);
    p_rope->pin(0);
    p_rope->pin(p_rope->getNodeCount() - 1);
    return p_rope;
  }
  static void pinSides(Cloth& cloth) {
    for (int row = 0; row < cloth.getRows(); ++row) {
      cloth.pin(cloth.getNode(0, row));
      cloth.pin(cloth.getNode(cloth.getColumns() - 1, row));
    }
  }
};

struct Floor : Object {
  explicit Floor(Vector corner, double width = 40, double height = 1) {
    setType("Floor");
    setPosition(corner);
    setBox(Box(Vector(0, 0), width, height));
  }
};

double lowest(const SoftBody& body) {
  double y = -1e300;
  for (int i = 0; i < body.getNodeCount(); ++i) y = std::max(y, body.getNodePosition(i).y());
  return y;
}

TEST_F(SoftObjects, WorldWithoutSoftBodiesHasNoLayer) {
  new Body;
  ticks(3);
  EXPECT_EQ(world.findLayer<naiad::physics::SoftLayer>(), nullptr);
}

TEST_F(SoftObjects, ABlobFallsLikeABody) {
  auto* p_blob = new Blob(Vector(20, 5), 3);
  p_blob->setDrag(0);
  auto* p_body = new Body;
  p_body->setPosition(Vector(40, 5));
  ticks(20);
  EXPECT_NEAR(p_blob->getPosition().x(), 20, 1e-9);
  EXPECT_NEAR(p_blob->getPosition().y(), p_body->getPosition().y(), 2e-3);
  EXPECT_NEAR(p_blob->getVelocity().y(), 0.4, 1e-6);
  const Box box = p_blob->getBox();
  EXPECT_GT(box.getHorizontal(), 6);
  EXPECT_LT(box.getHorizontal(), 8.5);
  EXPECT_LT(box.getVertical(), 5.5);
}

TEST_F(SoftObjects, ARestingBlobPublishesNothing) {
  new Floor(Vector(0, 20));
  auto* p_blob = new Blob(Vector(20, 15), 3);
  world.store().setWatched(true);
  ticks(500);
  ASSERT_TRUE(p_blob->isAsleep());
  const std::vector<DrawCommand> before = world.picture().view().commands;
  EXPECT_FALSE(before.empty());
  for (int i = 0; i < 60; ++i) {
    world.tick();
    EXPECT_TRUE(world.picture().view().changed.empty()) << i;
    ASSERT_EQ(world.picture().view().commands.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(world.picture().view().commands[k].position, before[k].position);
      EXPECT_EQ(world.picture().view().commands[k].ch, before[k].ch);
    }
  }
}

TEST_F(SoftObjects, SleepingBlobWakesOnImpactOrLostFloor) {
  auto* p_floor = new Floor(Vector(0, 20));
  auto* p_blob = new Blob(Vector(20, 15), 3);
  ticks(500);
  ASSERT_TRUE(p_blob->isAsleep());
  auto* p_stone = crate(Vector(20, 5), Vector(0.5, 0.5));
  const double top = p_blob->getPosition().y();
  ticks(60);
  EXPECT_LT(p_stone->getPosition().y(), top);
  EXPECT_GT(p_blob->getPosition().y(), top);
  WM.markForDelete(p_stone);
  ticks(700);
  ASSERT_TRUE(p_blob->isAsleep());
  WM.markForDelete(p_floor);
  ticks(30);
  EXPECT_GT(p_blob->getPosition().y(), top + 2);
}

TEST_F(SoftObjects, CrateRestingOnARopePublishesUnchangedState) {
  const Rope* p_rope = bridge();
  auto* p_crate = crate<test::Listener>(Vector(20, 8), Vector(2, 0.5));
  world.store().setWatched(true);
  ticks(900);
  EXPECT_LE(p_crate->begins(), 3);  // the crate may bounce
  ASSERT_FALSE(p_crate->notes.empty());
  EXPECT_EQ(p_crate->other(), p_rope);
  EXPECT_NEAR(p_crate->getPosition().x(), 20, 0.5);
  // The crate's lower edge lies on the rope, which its weight bends.
  const double edge = p_crate->getPosition().y() + 0.5;
  EXPECT_GT(edge, 10.1);
  EXPECT_LT(edge, 12);
  EXPECT_NEAR(lowest(*p_rope), edge, 0.3);
  const ObjectFacts of_rope = world.store().facts(p_rope->key().slot);
  const ObjectFacts of_crate = world.store().facts(p_crate->key().slot);
  EXPECT_EQ(of_crate.velocity, FixedVector{});
  const std::vector<DrawCommand> before = world.picture().view().commands;
  for (int i = 0; i < 60; ++i) {
    world.tick();
    for (const ObjectFacts& facts : world.picture().view().changed) {
      const ObjectFacts& published = facts.key == p_rope->key() ? of_rope : of_crate;
      EXPECT_EQ(facts.key, published.key);
      EXPECT_EQ(facts.position, published.position);
      EXPECT_EQ(facts.velocity, published.velocity);
      EXPECT_EQ(facts.acceleration, published.acceleration);
      EXPECT_EQ(facts.box, published.box);
    }
    ASSERT_EQ(world.picture().view().commands.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(world.picture().view().commands[k].position, before[k].position);
    }
  }
}

TEST_F(SoftObjects, ATurningStackLiesOnACloth) {
  auto* p_cloth = new Cloth(Vector(8, 12), 24, 2, 1, 200);
  pinSides(*p_cloth);
  const Body* p_below = turningCrate(Vector(20, 11), Vector(3, 0.5));
  const Body* p_crate = turningCrate(Vector(20, 9.5), Vector(3, 0.5));
  ticks(600);
  EXPECT_NEAR(p_crate->getAngle(), 0, 0.1);
  EXPECT_NEAR(p_below->getPosition().y() - p_crate->getPosition().y(), 1, 0.05);
  EXPECT_NEAR(p_crate->getPosition().x(), 20, 0.5);
  EXPECT_GT(p_below->getPosition().y(), 11.37);  // 12, less half of the crate and the thickness of the cloth
  EXPECT_LT(p_below->getPosition().y(), 13.5);
  const double y_before = p_below->getPosition().y();
  ticks(60);
  EXPECT_NEAR(p_below->getPosition().y(), y_before, 0.01);
}

TEST_F(SoftObjects, ABlobLiesOnACrateOnAFloor) {
  new Floor(Vector(0, 20));
  auto* p_crate = crate(Vector(20, 19), Vector(4, 1));
  auto* p_blob = new Blob(Vector(20, 14), 3);
  ticks(400);
  EXPECT_NEAR(p_crate->getPosition().y(), 19, 0.02);
  EXPECT_LT(lowest(*p_blob), 18.05);
  EXPECT_GT(lowest(*p_blob), 17);
}

TEST_F(SoftObjects, ABodyHangsOnARope) {
  auto* p_rope = new Rope(Vector(20, 2), Vector(20, 8), 0.1, 1000);
  p_rope->pin(0);
  auto* p_ball = new Body;
  p_ball->setCircle(1);
  p_ball->setSolidness(SPECTRAL);
  p_ball->setPosition(Vector(20, 8));
  ASSERT_EQ(p_rope->attach(p_rope->getNodeCount() - 1, p_ball), 0);
  ticks(300);
  EXPECT_NEAR(p_ball->getPosition().y(), 8, 0.3);
  EXPECT_NEAR(p_ball->getPosition().x(), 20, 0.1);
  p_rope->detach(p_rope->getNodeCount() - 1);
  ticks(20);
  EXPECT_GT(p_ball->getPosition().y(), 10);
}

TEST_F(SoftObjects, AttachedBodySwingsWithoutTouchingTheRope) {
  auto* p_rope = new Rope(Vector(20, 2), Vector(30, 2), 0.2, 200);
  p_rope->setDrag(0);
  p_rope->pin(0);
  auto* p_ball = new test::Listener;
  p_ball->setCircle(1.5);
  p_ball->setPosition(Vector(30, 2));
  ASSERT_EQ(p_rope->attach(p_rope->getNodeCount() - 1, p_ball), 0);
  double left = 30, right = 0;
  ticks(40);
  for (int i = 0; i < 40; ++i) {
    ticks(1);
    left = std::min(left, p_ball->getPosition().x());
  }
  for (int i = 0; i < 60; ++i) {
    ticks(1);
    right = std::max(right, p_ball->getPosition().x());
  }
  EXPECT_LT(left, 11);
  EXPECT_GT(right, 29);
  EXPECT_TRUE(p_ball->notes.empty());
}

TEST_F(SoftObjects, GrabbedBlobFollowsThePointer) {
  PM.setGravity(Vector(0, 0));
  auto* p_blob = new Blob(Vector(20, 10), 2);
  EXPECT_EQ(p_blob->dragTo(Vector(30, 10)), -1);
  ASSERT_EQ(p_blob->grab(Vector(22, 10), 5), 0);
  p_blob->dragTo(Vector(40, 12));
  ticks(200);
  EXPECT_NEAR(p_blob->getNodePosition(p_blob->getNearestNode(Vector(40, 12))).x(), 40, 0.1);
  EXPECT_NEAR(p_blob->getNodePosition(p_blob->getNearestNode(Vector(40, 12))).y(), 12, 0.1);
  p_blob->release();
  EXPECT_FALSE(p_blob->isGrabbed());
  p_blob->setVelocity(Vector(1, 0));
  ticks(10);
  EXPECT_GT(p_blob->getPosition().x(), 45);
}

TEST_F(SoftObjects, SettersForcesAndImpulsesTakeEffect) {
  PM.setGravity(Vector(0, 0));
  auto* p_blob = new Blob(Vector(20, 10), 2, 3);
  EXPECT_NEAR(p_blob->getMass(), 3, 1e-12);
  p_blob->setDrag(0);
  p_blob->setPosition(Vector(1e9, -7));
  p_blob->setVelocity(Vector(0.25, 0));
  ticks(8);
  EXPECT_NEAR(p_blob->getPosition().x() - 1e9, 2, 1e-6);
  p_blob->applyImpulse(Vector(0, 3));
  EXPECT_NEAR(p_blob->getNodeVelocity(0).y(), 1, 1e-9);
  p_blob->applyForce(Vector(-3, 0));
  ticks(1);
  EXPECT_NEAR(p_blob->getVelocity().x(), -0.75, 1e-6);
  ticks(1);
  EXPECT_NEAR(p_blob->getVelocity().x(), -0.75, 1e-6);
}

TEST_F(SoftObjects, InvalidNumbersAreRefused) {
  auto* p_blob = new Blob(Vector(20, 10), kNan, -1, 1e30);
  EXPECT_EQ(world.log().refusals(), 3u);
  EXPECT_NEAR(p_blob->getMass(), 1, 1e-12);
  EXPECT_EQ(p_blob->setPosition(Vector(kNan, 0)), -1);
  EXPECT_EQ(p_blob->applyImpulse(Vector(kNan, 0)), -1);
  EXPECT_EQ(p_blob->applyImpulse(Vector(0, 1e30)), -1);
  EXPECT_EQ(p_blob->applyForce(Vector(0, 1e30)), -1);
  EXPECT_EQ(p_blob->applyForce(1000, Vector(0, 1)), -1);
  EXPECT_EQ(p_blob->applyForce(0, Vector(0, 1e30)), -1);
  EXPECT_EQ(p_blob->applyForce(0, Vector(0.8e9, 0)), 0);
  EXPECT_EQ(p_blob->applyForce(0, Vector(0.8e9, 0)), -1);  // because the sum exceeds the limit
  EXPECT_EQ(p_blob->applyForce(0, Vector(-0.8e9, 0)), 0);
  EXPECT_EQ(p_blob->setFriction(-1), -1);
  EXPECT_EQ(p_blob->setDrag(kNan), -1);
  EXPECT_EQ(p_blob->setGravityScale(kNan), -1);
  EXPECT_EQ(p_blob->pin(1000), -1);
  EXPECT_EQ(p_blob->attach(0, nullptr), -1);
  EXPECT_EQ(p_blob->grab(Vector(0, 0), kNan), -1);
  EXPECT_EQ(p_blob->setDrawing(BodyDrawing::SPRITE), -1);
  EXPECT_EQ(PM.setAspect(1), -1);
  new Rope(Vector(5, 5), Vector(5, 5));
  new Beam(Vector(kNan, 5), Vector(5, 5));
  new Cloth(Vector(1, 1), 0, kNan);
  ticks(30);
  EXPECT_EQ(PM.getQuarantineCount(), 0u);
}

TEST_F(SoftObjects, RunawaySoftBodyFreezesUntilItIsMoved) {
  auto* p_runaway = new Rope(Vector(60, 10), Vector(70, 10));
  p_runaway->setPosition(Vector(1.9999999e9, 0));
  p_runaway->setVelocity(Vector(1e6, 0));
  ticks(20);
  EXPECT_TRUE(p_runaway->isFrozen());
  EXPECT_EQ(PM.getQuarantineCount(), 1u);
  p_runaway->setPosition(Vector(40, 5));
  EXPECT_FALSE(p_runaway->isFrozen());
  ticks(1);
  EXPECT_NEAR(p_runaway->getPosition().x(), 40, 0.01);
  EXPECT_NEAR(p_runaway->getNodePosition(0).x(), 35, 0.1);
}

TEST_F(SoftObjects, HandlersMayDeleteAnyObject) {
  new Floor(Vector(0, 20));
  new Floor(Vector(0, 25));
  auto* p_crate = new Body;
  p_crate->setPosition(Vector(22, 17));
  auto* p_rope = new Rope(Vector(15, 17), Vector(25, 17));
  p_rope->attach(0, p_crate);
  for (const double x : {20, 40}) {
    auto* p_vandal = new test::Touchy<Blob>(Vector(x, 12), 2);
    p_vandal->on_contact = [p_vandal, x](Object* p_other) {
      delete p_other;
      new Rope(p_vandal->getPosition(), p_vandal->getPosition() + Vector(5, 0));
      if (x == 40) delete p_vandal;
    };
  }
  ticks(200);
  EXPECT_EQ(WM.objectsOfType("Floor").getCount(), 0);
}

TEST_F(SoftObjects, HandlerOfABodyMayCreateTheFirstBlob) {
  new Floor(Vector(0, 20));
  auto* p_body = new test::Touchy<Body>;
  p_body->setPosition(Vector(20, 15));
  p_body->on_contact = [](Object* /*p_other*/) { new Blob(Vector(50, 5), 2); };
  ticks(100);
  EXPECT_NE(world.findLayer<naiad::physics::SoftLayer>(), nullptr);
  EXPECT_GT(WM.objectsOfType("Blob").getCount(), 0);
}

TEST_F(SoftObjects, StiffnessDeterminesTheSag) {
  constexpr double kGravity = 0.04;  // in cell widths per tick²
  const double rows = 0.5;           // rows per cell width
  auto* p_rope = new Rope(Vector(5, 2), Vector(5, 12), 3, 1);
  p_rope->pin(0);
  auto* p_beam = new Beam(Vector(10, 2), Vector(30, 2), 5, 2, true);
  const int rope_end = p_rope->getNodeCount() - 1, beam_end = p_beam->getNodeCount() - 1;
  ticks(1500);
  EXPECT_NEAR(p_rope->getNodePosition(rope_end).y() - 12, 20 * kGravity / 2 * rows, 0.01);
  EXPECT_NEAR(p_beam->getNodePosition(beam_end).y() - 2, 20 * kGravity / 2 * rows, 0.01);
}

// A force at the end of a clamped beam bends it by FL³/3EI, for any number of elements.
TEST_F(SoftObjects, EndForceBendsABeamByTheFormula) {
  PM.setGravity(Vector(0, 0));
  constexpr double kMass = 2, kStiffness = 1, kLength = 20, kForce = 0.02;  // rows
  constexpr double kEi = kStiffness * kMass * kLength * kLength / 8;
  const double rows = 0.5;  // rows per cell width
  const double expected = kForce / rows * kLength * kLength * kLength / (3 * kEi) * rows;
  for (const int elements : {8, 16, 32}) {
    auto* p_beam = new Beam(Vector(0, 100.0 * elements), Vector(kLength, 100.0 * elements), kMass, kStiffness,
                            true, elements);
    ASSERT_EQ(p_beam->getNodeCount(), elements + 1);
    p_beam->setDrag(0.1);
    for (int i = 0; i < 1000; ++i) {
      p_beam->applyForce(elements, Vector(0, kForce));
      ticks(1);
    }
    EXPECT_NEAR(p_beam->getNodePosition(elements).y() - 100.0 * elements, expected, 0.01 * expected)
        << elements;
    for (int i = 0; i < 1000; ++i) ticks(1);  // a force acts for one tick only
    EXPECT_NEAR(p_beam->getNodePosition(elements).y() - 100.0 * elements, 0, 0.05 * expected) << elements;
  }
}

TEST_F(SoftObjects, BlobsAreRoundDespiteTheCellAspect) {
  auto* p_blob = new Blob(Vector(20, 10), 4);
  std::vector<double> x, y;
  for (int i = 0; i < p_blob->getNodeCount(); ++i) {
    x.push_back(p_blob->getNodePosition(i).x());
    y.push_back(p_blob->getNodePosition(i).y());
  }
  EXPECT_NEAR(std::ranges::max(x) - std::ranges::min(x), 8, 0.2);
  EXPECT_NEAR(std::ranges::max(y) - std::ranges::min(y), 4, 0.1);
}

TEST_F(SoftObjects, SoftBodiesAreDrawn) {
  PM.setGravity(Vector(0, 0));
  auto* p_rope = new Rope(Vector(2, 2), Vector(7, 2));
  auto* p_fill = new Cloth(Vector(20, 2), 6, 3);
  p_fill->setDrawing(BodyDrawing::FILL, '%');
  auto* p_none = new Blob(Vector(40, 10), 3);
  p_none->setDrawing(BodyDrawing::NONE);
  auto* p_steep = new Beam(Vector(50, 2), Vector(50, 6));
  ASSERT_NE(p_rope, nullptr);
  ASSERT_NE(p_steep, nullptr);
  world.tick();
  const Canvas canvas = world.picture().render({});
  EXPECT_EQ(canvas.at(2, 2).ch, U'-');
  EXPECT_EQ(canvas.at(7, 2).ch, U'-');
  EXPECT_EQ(canvas.at(8, 2).ch, U' ');
  EXPECT_EQ(canvas.at(23, 3).ch, U'%');
  EXPECT_EQ(canvas.at(50, 4).ch, U'|');
  EXPECT_EQ(canvas.at(43, 10).ch, U' ');
}

TEST_F(SoftObjects, InactiveBlobStaysAndCollidesWithNothing) {
  auto* p_blob = new Blob(Vector(20, 10), 2);
  p_blob->setActive(false);
  auto* p_body = new Body;
  p_body->setPosition(Vector(20, 6));
  ticks(60);
  EXPECT_GT(p_body->getPosition().y(), 20);
  EXPECT_NEAR(p_blob->getPosition().y(), 10, 1e-9);
  p_blob->setActive();
  ticks(10);
  EXPECT_GT(p_blob->getPosition().y(), 10.5);
}

TEST_F(SoftObjects, DeletedBlobLeavesTheSolver) {
  auto* p_blob = new Blob(Vector(20, 10), 2);
  ticks(3);
  delete p_blob;
  ticks(3);
  EXPECT_EQ(PM.setAspect(1), 0);
}

TEST_F(SoftObjects, ClothHasTheRequestedThreadsWithinLimits) {
  const Cloth usual(Vector(0, 0), 1000, 1000);
  EXPECT_EQ(usual.getColumns(), 25);
  EXPECT_EQ(usual.getRows(), 25);
  const Cloth fine(Vector(0, 0), 30, 20, 1, 5, 128, 40);
  EXPECT_EQ(fine.getColumns(), 128);
  EXPECT_EQ(fine.getRows(), 40);
  EXPECT_EQ(fine.getNodeCount(), 128 * 40);
  EXPECT_NEAR(fine.getNodePosition(fine.getNode(127, 39)).x(), 30, 1e-6);
  EXPECT_NEAR(fine.getNodePosition(fine.getNode(127, 39)).y(), 20, 1e-6);
  const auto before = world.log().refusals();
  const Cloth refused(Vector(0, 0), 30, 20, 1, 5, 129, 1);
  EXPECT_EQ(world.log().refusals(), before + 2);
  EXPECT_EQ(refused.getColumns(), 13);
}

TEST_F(SoftObjects, PinnedClothStretchesByAtMostFivePercent) {
  constexpr int kThreads = 100;
  auto* p_cloth = new Cloth(Vector(10, 5), 99, 49.5, 1, 5, kThreads, kThreads);
  p_cloth->pin(p_cloth->getNode(0, 0));
  p_cloth->pin(p_cloth->getNode(kThreads - 1, 0));
  const double mesh = PM.getAspect() * 0.5;
  for (int i = 0; i < 60; ++i) {
    world.tick();
    for (int k = 0; k + 1 < kThreads; ++k) {
      for (const int other : {p_cloth->getNode(k + 1, 0), p_cloth->getNode(k, 1)}) {
        const Vector apart =
            p_cloth->getNodePosition(other) - p_cloth->getNodePosition(p_cloth->getNode(k, 0));
        ASSERT_LE(std::hypot(apart.x(), PM.getAspect() * apart.y()), 1.05 * std::max(1.0, mesh))
            << i << " " << k;
      }
    }
  }
  EXPECT_EQ(p_cloth->getNodePosition(p_cloth->getNode(0, 0)), Vector(10, 5));
  EXPECT_FALSE(p_cloth->isFrozen());
}

TEST_F(SoftObjects, NodeForcesMoveTheWholeCloth) {
  auto* p_cloth = new Cloth(Vector(10, 5), 20, 10, 1, 5, 40, 40);
  PM.setGravity(Vector(0, 0));
  for (int i = 0; i < 10; ++i) {
    for (int node = 0; node < p_cloth->getNodeCount(); ++node) {
      p_cloth->applyForce(node, Vector(0.01 / p_cloth->getNodeCount(), 0));
    }
    world.tick();
  }
  EXPECT_NEAR(p_cloth->getVelocity().x(), 0.1, 0.02);
  world.tick();
  const double speed = p_cloth->getVelocity().x();
  EXPECT_LE(speed, 0.1);
}

}  // namespace
}  // namespace df
