// Tests the contact events of soft bodies.

#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

// Counts the contacts of an Object that begin and end.
template <class Base>
struct Hearing : Base {
  using Base::Base;
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) {
      const auto& event = *static_cast<const EventCollision*>(p_e);
      ++begun;
      impulse = event.getImpulse();
      p_first = event.getObject1(), p_second = event.getObject2();
    } else if (p_e->getType() == CONTACT_END_EVENT) {
      const auto& event = *static_cast<const EventContactEnd*>(p_e);
      ++ended;
      EXPECT_EQ(event.getObject1(), p_first);
      EXPECT_EQ(event.getObject2(), p_second);
    } else {
      return 0;
    }
    return 1;
  }
  int begun = 0;
  int ended = 0;
  double impulse = 0;
  const Object* p_first = nullptr;
  const Object* p_second = nullptr;
};

using SoftTouch = BodyScene;

// The begin has the impulse that the crate got in that tick. The end is sent once, when the two separate.
TEST_F(SoftTouch, ImpactReportsItsImpulseAndLaterItsEnd) {
  auto* p_blob = new Hearing<Blob>(Vector(0, 0), 2);
  p_blob->setContactEnds();
  p_blob->setDrag(0);
  p_blob->setVelocity(Vector(0.2, 0));
  auto* p_crate = crate<Hearing<Body>>(Vector(5, 0), Vector(1, 1), 2);
  p_crate->setContactEnds();
  for (int i = 0; i < 200 && p_crate->begun == 0; ++i) {
    EXPECT_EQ(p_crate->getVelocity(), Vector());
    ticks(1);
  }
  EXPECT_EQ(p_crate->begun, 1);
  EXPECT_GT(p_crate->impulse, 0);
  EXPECT_NEAR(p_crate->impulse, 2 * p_crate->getVelocity().getMagnitude(), 1e-7);
  EXPECT_EQ(p_blob->impulse, p_crate->impulse);
  EXPECT_EQ(p_crate->ended, 0);
  ticks(100);
  EXPECT_GT(p_crate->getVelocity().x(), p_blob->getVelocity().x());
  EXPECT_EQ(p_blob->ended, p_blob->begun);
  EXPECT_EQ(p_crate->ended, p_crate->begun);
  EXPECT_EQ(p_crate->begun, p_blob->begun);
}

// A resting contact has one more begin than ends. After it is removed, the numbers are equal.
TEST_F(SoftTouch, RestingContactHasBegunButNotEnded) {
  PM.setGravity(Vector(0, 0.02));
  auto* p_floor = wall(Vector(0, 5), Vector(20, 1));
  auto* p_blob = new Hearing<Blob>(Vector(0, 0), 2);
  p_blob->setContactEnds();
  ticks(600);
  EXPECT_TRUE(p_blob->isAsleep());
  EXPECT_GE(p_blob->begun, 1);
  EXPECT_EQ(p_blob->ended, p_blob->begun - 1);
  EXPECT_EQ(p_blob->p_second, p_floor);
  const int begun = p_blob->begun;
  p_blob->setPosition(Vector(0, -20));
  ticks(2);
  EXPECT_EQ(p_blob->begun, begun);
  EXPECT_EQ(p_blob->ended, begun);
}

TEST_F(SoftTouch, EndsAreSentOnlyOnRequest) {
  auto* p_left = new Hearing<Blob>(Vector(0, 0), 2);
  auto* p_right = new Hearing<Blob>(Vector(6, 0), 2);
  p_right->setContactEnds();
  EXPECT_FALSE(p_left->hasContactEnds());
  EXPECT_TRUE(p_right->hasContactEnds());
  p_left->setVelocity(Vector(0.2, 0));
  ticks(200);
  EXPECT_GE(p_left->begun, 1);
  EXPECT_EQ(p_right->begun, p_left->begun);
  EXPECT_EQ(p_left->ended, 0);
  EXPECT_EQ(p_right->ended, p_right->begun);
}

// Deleting a body sends no contact end. A new body with its id in the solver begins new contacts.
TEST_F(SoftTouch, DeletedBodySendsNoContactEnd) {
  PM.setGravity(Vector(0, 0.02));
  auto* p_floor = new Hearing<Body>;
  p_floor->setBoxShape(40, 2);
  p_floor->setPosition(Vector(0, 5));
  p_floor->setKinematic();
  p_floor->setContactEnds();
  auto* p_blob = new Blob(Vector(0, 1.7), 2);
  ticks(30);
  const int begun = p_floor->begun, ended = p_floor->ended;
  EXPECT_EQ(begun - ended, 1);
  delete p_blob;
  new Blob(Vector(1, 1.7), 2);
  ticks(30);
  EXPECT_GT(p_floor->begun, begun);
  EXPECT_EQ(p_floor->begun - p_floor->ended, 2);
}

}  // namespace
}  // namespace df::test
