#include "SweptWorld.h"

namespace df::test {
namespace {

class RestContacts : public SweptWorld {
 protected:
  Probe* makeMine(Solidness solidness = HARD) {
    Probe* mine = make("mine", 10, 10, solidness);
    mine->setRestContacts();
    return mine;
  }
};

TEST_F(RestContacts, RestingObjectGetsACollisionEachUpdate) {
  Probe* mine = makeMine();
  make("b", 11, 10, SOFT);
  make("apart", 12.5, 10);
  for (int i = 0; i < 2; ++i) WM.update();
  EXPECT_EQ(received,
            (Received{"mine:df-collision", "b:df-collision", "mine:df-collision", "b:df-collision"}));
  expectAt(*mine, 10, 10);
}

TEST_F(RestContacts, AreOffByDefaultAndCanBeSwitchedOff) {
  Probe* mine = make("mine", 10, 10);
  make("b", 11, 10);
  WM.update();
  mine->setRestContacts();
  mine->setRestContacts(false);
  WM.update();
  EXPECT_TRUE(received.empty());
}

TEST_F(RestContacts, MovingObjectIsTestedOnlyOnce) {
  Probe* mine = makeMine();
  mine->setVelocity(Vector(1, 0));
  make("b", 12, 10, SOFT);
  WM.update();
  EXPECT_EQ(received.size(), 2u);
  expectAt(*mine, 11, 10);
}

TEST_F(RestContacts, SpectralAndInactiveObjectsGetNoEvents) {
  Probe* mine = makeMine(SPECTRAL);
  make("b", 11, 10);
  WM.update();
  mine->setSolidness(HARD);
  mine->setActive(false);
  WM.update();
  EXPECT_TRUE(received.empty());
}

TEST_F(RestContacts, SweptRestingObjectAlsoCollides) {
  Probe* mine = makeMine();
  mine->setSwept();
  make("b", 11, 10);
  WM.update();
  EXPECT_EQ(received, (Received{"mine:df-collision", "b:df-collision"}));
}

TEST_F(RestContacts, HandlersMayDeleteBoth) {
  Probe* mine = makeMine();
  Probe* b = make("b", 11, 10);
  mine->on_event = [b](Probe& self, const Event&) {
    delete b;
    delete &self;
  };
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(RestContacts, RestingObjectStillAccelerates) {
  Probe* mine = makeMine();
  mine->setAcceleration(Vector(0.5, 0));
  make("b", 9, 10, SOFT);
  WM.update();
  EXPECT_EQ(received.size(), 2u);
  EXPECT_EQ(mine->getVelocity(), Vector(0.5, 0));
}

}  // namespace
}  // namespace df::test
