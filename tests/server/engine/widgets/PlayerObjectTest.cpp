#include "engine/widgets/PlayerObject.h"
#include "tests/server/engine/Probe.h"

namespace df {
namespace {

// A class derived from Object, used as the base of a PlayerObject.
struct Boat : Object {
  Boat() { setType("Boat"); }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == OUT_EVENT) ++outs;
    return 0;
  }
  int outs = 0;
};

struct Ferry : PlayerObject<Boat> {
  explicit Ferry(Player& player) : PlayerObject(player) {
    setSolidness(SPECTRAL);
    setPosition(Vector(5, 5));
  }
  void step() override { received.push_back("step"); }
  void keyboard(const EventKeyboard& event) override {
    received.push_back(event.getKey() == Keyboard::A ? "A" : "key");
  }
  void mouse(const EventMouse& event) override { setPosition(event.getMousePosition()); }
  std::vector<std::string> received;
};

class PlayerObjects : public test::WorldTest {
 protected:
  PlayerObjects() { new JoinSpawner<Ferry>; }
  Ferry* ferryOf(std::uint32_t player) {
    return static_cast<Ferry*>(world.views().player(player)->getObject());
  }
};

TEST_F(PlayerObjects, EachJoiningPlayerGetsAnObject) {
  EXPECT_TRUE(WM.objectsOfType("Boat").isEmpty());
  const std::uint32_t ann = joined("ann"), bob = joined("bob", BLUE);
  ASSERT_EQ(WM.objectsOfType("Boat").getCount(), 2);
  EXPECT_NE(ferryOf(ann), ferryOf(bob));
  EXPECT_EQ(ferryOf(ann)->getPlayer(), world.views().player(ann));
  EXPECT_EQ(ferryOf(ann)->getColor(), world.views().player(ann)->getColor());
  EXPECT_EQ(ferryOf(bob)->getColor(), world.views().player(bob)->getColor());
}

TEST_F(PlayerObjects, EachObjectGetsOnlyItsPlayersInput) {
  const std::uint32_t ann = joined("ann"), bob = joined("bob", BLUE);
  ferryOf(ann)->received.clear(), ferryOf(bob)->received.clear();
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  world.input().mouse(bob, CLICKED, Mouse::LEFT, 9, 7);
  world.tick();
  EXPECT_EQ(ferryOf(ann)->received, (std::vector<std::string>{"step", "A"}));
  EXPECT_EQ(ferryOf(bob)->received, (std::vector<std::string>{"step"}));
  EXPECT_EQ(ferryOf(ann)->getPosition(), Vector(5, 5));
  EXPECT_EQ(ferryOf(bob)->getPosition(), Vector(9, 7));
}

TEST_F(PlayerObjects, OtherEventsReachTheBaseClass) {
  const std::uint32_t ann = joined("ann");
  ferryOf(ann)->setVelocity(Vector(-10, 0));
  world.tick();
  EXPECT_EQ(ferryOf(ann)->outs, 1);
}

TEST_F(PlayerObjects, ObjectIsDeletedWhenItsPlayerLeaves) {
  const std::uint32_t ann = joined("ann"), bob = joined("bob", BLUE);
  Ferry* p_left = ferryOf(bob);
  world.input().leave(ann);
  ticks(2);
  ASSERT_EQ(WM.objectsOfType("Boat").getCount(), 1);
  EXPECT_EQ(WM.objectsOfType("Boat")[0], p_left);
  EXPECT_EQ(p_left->getPlayer(), world.views().player(bob));
}

// The Object may still get a step event in the tick in which its player leaves; getPlayer() is then null.
TEST_F(PlayerObjects, ObjectWithoutAPlayerGetsNoStep) {
  const std::uint32_t ann = joined("ann");
  Ferry* p_ferry = ferryOf(ann);
  p_ferry->unregisterInterest(LEAVE_EVENT);
  world.input().leave(ann);
  ticks(2);
  p_ferry->received.clear();
  world.tick();
  EXPECT_EQ(p_ferry->getPlayer(), nullptr);
  EXPECT_TRUE(p_ferry->received.empty());
}

}  // namespace
}  // namespace df
