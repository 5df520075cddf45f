// Copies of Objects: games keep Objects in vectors and assign them to members.

#include "engine/widgets/ViewObject.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using ObjectCopy = WorldTest;

// A copied class of a game, which declares no copy operations.
class Card : public Object {
 public:
  explicit Card(int new_cost = 0) : cost(new_cost) {
    setType("Card");
    registerInterest("turn");
  }
  int eventHandler(const Event*) override { return ++received; }
  int cost;
  int received = 0;
};

TEST_F(ObjectCopy, HasTheSameAttributesAndAnotherId) {
  Card card(3);
  card.setPosition(Vector(4, 5));
  card.setVelocity(Vector(0.5, 0.25));
  card.setAcceleration(Vector(0, 0.125));
  card.setAltitude(4);
  card.setSolidness(SOFT);
  card.setNoSoft();
  card.setBox(Box(Vector(-1, -1), 2, 2));
  card.setVisible(false);
  Shape circle;
  circle.setSize(7);
  card.setShape(circle);
  const Card copy = card;
  EXPECT_EQ(copy.getType(), "Card");
  EXPECT_EQ(copy.cost, 3);
  expectAt(copy, 4, 5);
  EXPECT_EQ(copy.getVelocity(), Vector(0.5, 0.25));
  EXPECT_EQ(copy.getSpeed(), card.getSpeed());
  EXPECT_EQ(copy.getDirection(), card.getDirection());
  EXPECT_EQ(copy.getAcceleration(), Vector(0, 0.125));
  EXPECT_EQ(copy.getAltitude(), 4);
  EXPECT_EQ(copy.getSolidness(), SOFT);
  EXPECT_TRUE(copy.getNoSoft());
  EXPECT_EQ(copy.getBox(), card.getBox());
  EXPECT_FALSE(copy.isVisible());
  EXPECT_EQ(copy.getShape(), circle);
  EXPECT_NE(copy.getId(), card.getId());
  EXPECT_EQ(copy.getEventCount(), 0);
  EXPECT_EQ(card.getEventCount(), 1);
}

TEST_F(ObjectCopy, IsNotInTheWorld) {
  Card card;
  card.setVelocity(Vector(1, 0));
  std::vector<Card> hand;
  for (int i = 0; i < 5; ++i) hand.push_back(card);
  EXPECT_EQ(WM.getAllObjects().getCount(), 1);
  EXPECT_TRUE(WM.getCollisions(&card, Vector()).isEmpty());
  Event turn;
  turn.setType("turn");
  EXPECT_EQ(WM.onEvent(&turn), 1);
  world.update();
  EXPECT_EQ(card.received, 1);
  expectAt(card, 1, 0);
  for (const Card& copy : hand) {
    EXPECT_EQ(copy.received, 0);
    expectAt(copy, 0, 0);
  }
  EXPECT_EQ(WM.markForDelete(hand.data()), -1);
  hand.clear();
  EXPECT_EQ(WM.getAllObjects().getCount(), 1);
}

TEST_F(ObjectCopy, EntersTheWorldWhenInserted) {
  Card card;
  Card copy = card;
  EXPECT_EQ(WM.insertObject(&copy), 0);
  EXPECT_EQ(WM.getAllObjects().getCount(), 2);
  card.setPosition(Vector(20, 20));  // so that it does not touch the copy
  copy.setVelocity(Vector(1, 0));
  world.update();
  expectAt(copy, 1, 0);
}

// Games assign temporaries to members: `reticle = Reticle();`
TEST_F(ObjectCopy, AssignmentKeepsIdAndInterests) {
  Card card(1);
  const int id = card.getId();
  {
    Card other(2);
    other.setPosition(Vector(7, 8));
    other.setType("Ace");
    card = other;
  }
  EXPECT_EQ(card.getId(), id);
  EXPECT_EQ(card.cost, 2);
  EXPECT_EQ(card.getType(), "Ace");
  expectAt(card, 7, 8);
  EXPECT_EQ(WM.getAllObjects().getCount(), 1);
  Event turn;
  turn.setType("turn");
  EXPECT_EQ(WM.onEvent(&turn), 1);
  EXPECT_EQ(card.received, 1);
}

TEST_F(ObjectCopy, ViewObjectAssignmentCopiesItsText) {
  ViewObject points;
  points.setViewString("Points");
  points.setValue(5);
  ViewObject mana;
  mana = points;
  EXPECT_EQ(mana.getViewString(), "Points");
  EXPECT_EQ(mana.getValue(), 5);
  EXPECT_EQ(mana.getLocation(), points.getLocation());
  EXPECT_EQ(WM.getAllObjects().getCount(), 2);
}

}  // namespace
}  // namespace df::test
