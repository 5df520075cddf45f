// Tests the contact events of soft bodies.

#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

using SoftTouch = BodyScene;

// The begin has the impulse that the crate got in that tick. The end is sent once, when the two separate.
TEST_F(SoftTouch, ImpactReportsItsImpulseAndLaterItsEnd) {
  auto* p_blob = new Recording<Blob>(Vector(0, 0), 2);
  p_blob->setContactEnds();
  p_blob->setDrag(0);
  p_blob->setVelocity(Vector(0.2, 0));
  auto* p_crate = crate<Recording<Body>>(Vector(5, 0), Vector(1, 1), 2);
  p_crate->setContactEnds();
  for (int i = 0; i < 200 && p_crate->begins() == 0; ++i) {
    EXPECT_EQ(p_crate->getVelocity(), Vector());
    ticks(1);
  }
  ASSERT_EQ(p_crate->notes.size(), 1u);
  ASSERT_EQ(p_blob->notes.size(), 1u);
  EXPECT_GT(p_crate->notes[0].impulse, 0);
  EXPECT_NEAR(p_crate->notes[0].impulse, 2 * p_crate->getVelocity().getMagnitude(), 1e-7);
  EXPECT_EQ(p_blob->notes[0].impulse, p_crate->notes[0].impulse);
  ticks(100);
  EXPECT_GT(p_crate->getVelocity().x(), p_blob->getVelocity().x());
  EXPECT_EQ(p_blob->ends(), p_blob->begins());
  EXPECT_EQ(p_crate->ends(), p_crate->begins());
  EXPECT_EQ(p_crate->begins(), p_blob->begins());
  p_crate->expectTurns();
}

// A resting contact has one more begin than ends, and both Objects get the begins. After it is removed, the
// numbers are equal.
TEST_F(SoftTouch, RestingContactHasBegunButNotEnded) {
  PM.setGravity(Vector(0, 0.02));
  auto* p_floor = wall<Recording<Object>>(Vector(0, 5), Vector(20, 1));
  auto* p_blob = new Recording<Blob>(Vector(0, 0), 2);
  p_blob->setContactEnds();
  ticks(600);
  EXPECT_TRUE(p_blob->isAsleep());
  EXPECT_GE(p_blob->begins(), 1);
  EXPECT_EQ(p_blob->ends(), p_blob->begins() - 1);
  EXPECT_EQ(p_blob->other(), p_floor);
  EXPECT_EQ(p_floor->other(), p_blob);
  EXPECT_EQ(p_floor->begins(), p_blob->begins());
  EXPECT_GT(p_blob->notes[0].impulse, 0);
  const int begun = p_blob->begins();
  p_blob->setPosition(Vector(0, -20));
  ticks(2);
  EXPECT_EQ(p_blob->begins(), begun);
  EXPECT_EQ(p_blob->ends(), begun);
}

TEST_F(SoftTouch, EndsAreSentOnlyOnRequest) {
  auto* p_left = new Recording<Blob>(Vector(0, 0), 2);
  auto* p_right = new Recording<Blob>(Vector(6, 0), 2);
  p_right->setContactEnds();
  EXPECT_FALSE(p_left->hasContactEnds());
  EXPECT_TRUE(p_right->hasContactEnds());
  p_left->setVelocity(Vector(0.2, 0));
  ticks(200);
  EXPECT_GE(p_left->begins(), 1);
  EXPECT_EQ(p_right->begins(), p_left->begins());
  EXPECT_EQ(p_left->other(), p_right);
  EXPECT_EQ(p_left->ends(), 0);
  EXPECT_EQ(p_right->ends(), p_right->begins());
}

// Deleting a body ends its contact. A new body with its id in the solver begins a new one.
TEST_F(SoftTouch, DeletedBodyEndsItsContact) {
  PM.setGravity(Vector(0, 0.02));
  auto* p_floor = new Recording<Body>;
  p_floor->setBoxShape(40, 2);
  p_floor->setPosition(Vector(0, 5));
  p_floor->setKinematic();
  p_floor->setContactEnds();
  auto* p_blob = new Blob(Vector(0, 1.7), 2);
  ticks(30);
  const int begun = p_floor->begins(), ended = p_floor->ends();
  EXPECT_EQ(begun - ended, 1);
  delete p_blob;
  new Blob(Vector(1, 1.7), 2);
  ticks(30);
  EXPECT_GT(p_floor->begins(), begun);
  EXPECT_EQ(p_floor->begins() - p_floor->ends(), 1);
}

}  // namespace
}  // namespace df::test
