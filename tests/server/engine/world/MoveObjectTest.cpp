// moveObject() beyond the oracle's random worlds, which compare every rule of the book and of
// docs/collisions.md: long paths, the number limit and refusals.
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

/// The distance between neighbouring positions, in cells.
constexpr double kUnit = 1 / 4294967296.0;

class MoveObject : public WorldTest {
 protected:
  Probe* make(const std::string& name, double x, double y, Solidness solidness = HARD) {
    auto* p = new Probe(name, &received, Vector(x, y));
    p->setSolidness(solidness);
    return p;
  }
  Probe* makeSwept(const std::string& name, double x, double y) {
    Probe* p = make(name, x, y);
    p->setSwept();
    return p;
  }
};

TEST_F(MoveObject, SweptMoverIsStoppedAtTheNumberLimit) {
  const double far = 1999999999;
  Probe* a = makeSwept("a", far - 40, -far);
  Probe* b = make("b", far, -far);
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -far)), -1);
  // A double has no higher precision at such positions.
  EXPECT_NEAR(a->getPosition().x(), far - 1, 1e-6);
  delete b;
  a->setPosition(Vector(-2e9, 2e9));
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -2e9)), 0);
  EXPECT_EQ(WM.moveObject(a, Vector(-2e9, 2e9)), 0);
  make("middle", 0, 0);
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -2e9)), -1);
  expectAt(*a, -1 - kUnit, 1 + kUnit);
}

TEST_F(MoveObject, ViewFollowsASweptMover) {
  WM.setBoundary(Box(Vector(), 400, 24));
  make("wall", 201, 10);
  Probe* a = makeSwept("a", 40, 10);
  WM.setViewFollowing(a);
  WM.moveObject(a, Vector(300, 10));
  const double left = WM.getView().getCorner().x();
  EXPECT_GT(left, 100);
  EXPECT_LT(left, 200);
}

TEST_F(MoveObject, SweptMoverStopsAfterAThousandReplacedGlasses) {
  Probe* a = makeSwept("a", 10, 10);
  make("glass", 20, 10);
  int glasses = 0;
  a->on_event = [&](Probe&, const Event& e) {
    ++glasses;
    delete dynamic_cast<const EventCollision&>(e).getObject2();
    make("glass", 20, 10);
  };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(glasses, 1000);
  expectAt(*a, 19 - kUnit, 10);
}

TEST_F(MoveObject, FirstContactReturnsTheTargetWithoutAContact) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 20, 10);
  const auto expectNobody = [&](const Object* p_o, Vector where) {
    const Contact contact = WM.firstContact(p_o, where);
    EXPECT_EQ(contact.p_object, nullptr);
    EXPECT_EQ(contact.time, 1);
    EXPECT_EQ(contact.position, where);
  };
  expectNobody(a, Vector(10, 50));
  expectNobody(a, Vector(18.5, 10));
  expectNobody(nullptr, Vector(50, 10));
  expectNobody(a, Vector(3e9, 10));
  b->setActive(false);
  expectNobody(a, Vector(50, 10));
  b->setActive(true);
  a->setSolidness(SPECTRAL);
  expectNobody(a, Vector(50, 10));
  a->setSolidness(HARD);
  a->setActive(false);
  expectNobody(a, Vector(50, 10));
  a->setActive(true);
  WM.removeObject(a);
  expectNobody(a, Vector(50, 10));
  WM.insertObject(a);
  EXPECT_EQ(WM.firstContact(a, Vector(50, 10)).p_object, b);
}

}  // namespace
}  // namespace df::test
