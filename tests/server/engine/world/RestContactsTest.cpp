#include <string>
#include <vector>

#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using Received = std::vector<std::string>;

class RestContacts : public WorldTest {
 protected:
  Probe* make(const std::string& name, double x, Solidness solidness = HARD) {
    auto* p = new Probe(name, &received, Vector(x, 10));
    p->setSolidness(solidness);
    return p;
  }
};

TEST_F(RestContacts, OneAtRestGetsACollisionAtEachTurn) {
  Probe* mine = make("mine", 10);
  mine->setRestContacts();
  make("b", 11, SOFT);
  make("apart", 12.5);
  for (int i = 0; i < 2; ++i) WM.update();
  EXPECT_EQ(received,
            (Received{"mine:df-collision", "b:df-collision", "mine:df-collision", "b:df-collision"}));
  expectAt(*mine, 10, 10);
}

TEST_F(RestContacts, AreOffByDefaultAndCanBeSwitchedOff) {
  Probe* mine = make("mine", 10);
  make("b", 11);
  WM.update();
  mine->setRestContacts();
  mine->setRestContacts(false);
  WM.update();
  EXPECT_TRUE(received.empty());
}

TEST_F(RestContacts, OneThatMovesIsTestedOnceAsAlways) {
  Probe* mine = make("mine", 10);
  mine->setRestContacts();
  mine->setVelocity(Vector(1, 0));
  make("b", 12, SOFT);
  WM.update();
  EXPECT_EQ(received.size(), 2u);
  expectAt(*mine, 11, 10);
}

TEST_F(RestContacts, SpectralAndInactiveOnesGetNoEvents) {
  Probe* mine = make("mine", 10, SPECTRAL);
  mine->setRestContacts();
  make("b", 11);
  WM.update();
  mine->setSolidness(HARD);
  mine->setActive(false);
  WM.update();
  EXPECT_TRUE(received.empty());
}

TEST_F(RestContacts, AreTheSameForASweptOne) {
  Probe* mine = make("mine", 10);
  mine->setRestContacts();
  mine->setSwept();
  make("b", 11);
  WM.update();
  EXPECT_EQ(received, (Received{"mine:df-collision", "b:df-collision"}));
}

TEST_F(RestContacts, HandlersMayDeleteBoth) {
  Probe* mine = make("mine", 10);
  mine->setRestContacts();
  Probe* b = make("b", 11);
  mine->on_event = [b](Probe& self, const Event&) {
    delete b;
    delete &self;
  };
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(RestContacts, OneAtRestStillAccelerates) {
  Probe* mine = make("mine", 10);
  mine->setRestContacts();
  mine->setAcceleration(Vector(0.5, 0));
  make("b", 9, SOFT);
  WM.update();
  EXPECT_EQ(received.size(), 2u);
  EXPECT_EQ(mine->getVelocity(), Vector(0.5, 0));
}

}  // namespace
}  // namespace df::test
