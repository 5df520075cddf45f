#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Precise : public WorldTest {
 protected:
  Probe* make(const std::string& name, double x, double y, const std::vector<std::string>& rows = {}) {
    auto* p = new Probe(name, &received, Vector(x, y));
    if (rows.empty()) return p;
    p->setBox(Box(Vector(-0.5, -0.5), static_cast<double>(rows[0].size()), static_cast<double>(rows.size())));
    EXPECT_EQ(p->setMask(rows), 0);
    return p;
  }
  /// Makes an L-shaped corner: the top row and the left column of a 4 by 4 square.
  Probe* makeCorner(double x, double y) {
    Probe* p = make("corner", x, y, {"####", "#   ", "#   ", "#   "});
    p->setPrecise();
    return p;
  }
};

TEST_F(Precise, SetCharactersCollideAndHolesDoNot) {
  Probe* corner = makeCorner(10, 10);
  Probe* a = make("a", 30, 12);
  EXPECT_EQ(WM.moveObject(a, Vector(12, 12)), 0);
  expectAt(*a, 12, 12);
  EXPECT_TRUE(received.empty());
  a->setPosition(Vector(30, 12));
  EXPECT_EQ(WM.moveObject(a, Vector(12, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "corner:df-collision"}));
  corner->setPrecise(false);
  EXPECT_EQ(WM.moveObject(a, Vector(12, 12)), -1) << "the mask counts for nothing";
}

TEST_F(Precise, EitherOfTheTwoMakesThePairPrecise) {
  Probe* corner = makeCorner(10, 10);
  corner->setPrecise(false);
  Probe* a = make("a", 30, 12);
  a->setPrecise();
  EXPECT_EQ(WM.moveObject(a, Vector(12, 12)), 0);
  EXPECT_EQ(WM.moveObject(corner, Vector(10, 10)), 0);
  EXPECT_TRUE(received.empty());
}

TEST_F(Precise, OtherPairsStillCollideByBoxes) {
  makeCorner(10, 10);
  make("b", 40, 12);
  Probe* a = make("a", 30, 12);
  EXPECT_EQ(WM.moveObject(a, Vector(39, 12)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
}

TEST_F(Precise, AdjacentCharactersShareNoCell) {
  make("b", 20, 10)->setPrecise();
  Probe* a = make("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(19, 10)), 0);
  EXPECT_EQ(WM.moveObject(a, Vector(19.5, 10)), -1);
}

TEST_F(Precise, GetCollisionsComparesCharacters) {
  Probe* corner = makeCorner(10, 10);
  Probe* b = make("b", 13, 12);
  const Probe* a = make("a", 30, 12);
  const ObjectList in_the_hole = WM.getCollisions(a, Vector(12, 12));
  ASSERT_EQ(in_the_hole.getCount(), 1);
  EXPECT_EQ(in_the_hole[0], b);
  const ObjectList on_the_edge = WM.getCollisions(a, Vector(11, 10));
  ASSERT_EQ(on_the_edge.getCount(), 1);
  EXPECT_EQ(on_the_edge[0], corner);
  EXPECT_FALSE(WM.isCollision(a, Vector(11, 12)));
}

TEST_F(Precise, UpdateMovesCharactersIntoHoles) {
  makeCorner(10, 10);
  Probe* a = make("a", 16, 12);
  a->setVelocity(Vector(-1, 0));
  Probe* b = make("b", 16, 10);
  b->setVelocity(Vector(-1, 0));
  for (int i = 0; i < 10; ++i) WM.update();
  expectAt(*a, 11, 12);  // stopped by the left column
  expectAt(*b, 14, 10);
}

TEST_F(Precise, DeletedPreciseObjectAffectsNoOthers) {
  delete makeCorner(10, 10);
  make("b", 20, 10);
  Probe* a = make("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(19, 10)), -1);
}

TEST_F(Precise, SweptMoverStopsAtCharactersInside) {
  makeCorner(10, 10);
  Probe* a = make("a", 30, 12);
  a->setSwept();
  EXPECT_EQ(WM.moveObject(a, Vector(0, 12)), -1);
  // One step further, `a` would enter the cell of the left column.
  EXPECT_EQ(a->getPosition().y(), 12);
  EXPECT_EQ(a->getPosition().x(), 10.5);
}

TEST_F(Precise, SweptMoverFliesThroughHoles) {
  Probe* gate = make("gate", 20, 8, {"#", " ", " ", "#"});
  gate->setPrecise();
  Probe* a = make("a", 10, 9);
  a->setSwept();
  EXPECT_EQ(WM.moveObject(a, Vector(40, 10)), 0);
  EXPECT_TRUE(received.empty());
  EXPECT_EQ(WM.moveObject(a, Vector(0, 12)), -1);
}

TEST_F(Precise, FirstContactComparesCharacters) {
  Probe* corner = makeCorner(10, 10);
  const Probe* a = make("a", 30, 12);
  EXPECT_EQ(WM.firstContact(a, Vector(12, 12)).p_object, nullptr);
  const Contact contact = WM.firstContact(a, Vector(0, 12));
  EXPECT_EQ(contact.p_object, corner);
  EXPECT_EQ(contact.position, Vector(10.5, 12));
}

}  // namespace
}  // namespace df::test
