#include <cmath>

#include "engine/world/Controls.h"
#include "engine/world/Player.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using namespace Keyboard;

Controls arrows(int wait = 0) {
  return Controls().onKey(LEFTARROW).step(-1, 0).every(wait).onKey(RIGHTARROW).step(1, 0).every(wait);
}

/// A player that steers a ship at (10,10).
class DeclaredControls : public WorldTest {
 protected:
  DeclaredControls() : id(world.input().join("ann", RED)) {
    GM.tick();
    player().setObject(&ship);
  }
  Player& player() { return *WM.getPlayer(id); }
  void press(Key key, EventKeyboardAction action = KEY_PRESSED) {
    world.input().key(id, key, action);
    GM.tick();
  }

  std::uint32_t id;
  Probe ship{"ship", &received, Vector(10, 10)};
};

TEST_F(DeclaredControls, KeyMovesTheObjectBeforeItsEvent) {
  ASSERT_EQ(player().setControls(arrows()), 0);
  Vector at_event;
  std::vector<bool> handled;
  Probe listener("listener", nullptr, Vector(50, 20));
  listener.hear(KEYBOARD_EVENT, [&](Probe&, const Event& e) {
    at_event = ship.getPosition();
    handled.push_back(static_cast<const EventKeyboard&>(e).isHandled());
  });
  press(RIGHTARROW);
  EXPECT_EQ(at_event, Vector(11, 10));
  press(RIGHTARROW, KEY_RELEASED);
  press(A);
  expectAt(ship, 11, 10);
  EXPECT_EQ(handled, (std::vector{true, false, false}));
}

TEST_F(DeclaredControls, WithoutControlsKeysMoveNothing) {
  Probe listener("listener", nullptr, Vector(50, 20));
  bool handled = true;
  listener.hear(KEYBOARD_EVENT,
                [&](Probe&, const Event& e) { handled = static_cast<const EventKeyboard&>(e).isHandled(); });
  press(RIGHTARROW);
  EXPECT_FALSE(handled);
  expectAt(ship, 10, 10);
  EXPECT_EQ(player().facts().steering.p_table, nullptr);
}

TEST_F(DeclaredControls, HardObjectBlocksAStepAndBothGetEvents) {
  player().setControls(arrows());
  const Probe wall("wall", &received, Vector(11.5, 10));
  press(RIGHTARROW);
  expectAt(ship, 10, 10);
  EXPECT_EQ(received, (std::vector<std::string>{"ship:df-collision", "wall:df-collision"}));
}

TEST_F(DeclaredControls, SoftObjectAllowsAStepAndGetsAnEvent) {
  player().setControls(arrows());
  Probe fog("fog", &received, Vector(11.5, 10));
  fog.setSolidness(SOFT);
  press(RIGHTARROW);
  expectAt(ship, 11, 10);
  EXPECT_EQ(received, (std::vector<std::string>{"ship:df-collision", "fog:df-collision"}));
  ship.setPosition(Vector(10, 10));
  ship.setNoSoft();
  press(RIGHTARROW);
  expectAt(ship, 10, 10);
}

TEST_F(DeclaredControls, StepOutOfTheWorldSendsOneOutEvent) {
  player().setControls(arrows());
  ship.setPosition(Vector(0, 10));
  press(LEFTARROW);
  press(LEFTARROW);
  expectAt(ship, -2, 10);
  EXPECT_EQ(received, (std::vector<std::string>{"ship:df-out"}));
}

TEST_F(DeclaredControls, ViewFollowsSteps) {
  WM.setBoundary(Box(Vector(), 200, 24));
  ship.setPosition(Vector(40, 10));
  player().setObject(&ship);
  player().setControls(Controls().onKey(D).step(10, 0));
  for (int i = 0; i < 3; ++i) press(D);
  EXPECT_EQ(ship.getPosition(), Vector(70, 10));
  EXPECT_NEAR(player().getViewCorner().x(), 70 - (80 - 80 / 3.0), 0.01);
}

TEST_F(DeclaredControls, StepsHonourTheDeclaredWait) {
  player().setControls(arrows(3));
  for (int i = 0; i < 6; ++i) press(RIGHTARROW);
  expectAt(ship, 12, 10);
}

TEST_F(DeclaredControls, VelocitiesAndDrivesMoveInTheSameTick) {
  player().setControls(Controls().onKey(S).velocityY(0.5).onKey(D).drive(1, 0));
  press(S);
  expectAt(ship, 10, 10.5);
  press(D);
  expectAt(ship, 11, 11);
  press(D, KEY_RELEASED);
  GM.tick();
  expectAt(ship, 12, 12);
  EXPECT_EQ(ship.getVelocity(), Vector(0, 0.5));
  EXPECT_EQ(ship.getSpeed(), 0.5f);
}

TEST_F(DeclaredControls, OnlyThePlayersOwnKeysMoveTheirObject) {
  player().setControls(arrows());
  const std::uint32_t bob = world.input().join("bob", GREEN);
  pressedBy({bob}, RIGHTARROW);
  expectAt(ship, 10, 10);
}

TEST_F(DeclaredControls, DisabledSteeringOrInactiveObjectIgnoresKeys) {
  player().setControls(arrows());
  player().setSteering(false);
  press(RIGHTARROW);
  player().setSteering();
  ship.setActive(false);
  press(RIGHTARROW);
  expectAt(ship, 10, 10);
  EXPECT_FALSE(player().facts().steering.state.steering);
  ship.setActive();
  EXPECT_TRUE(player().facts().steering.state.steering);
  press(RIGHTARROW);
  expectAt(ship, 11, 10);
}

TEST_F(DeclaredControls, ObjectMayBeDeletedDuringAKey) {
  auto* p_doomed = new Probe("doomed", nullptr, Vector(30, 10));
  player().setObject(p_doomed);
  player().setControls(Controls().onKey(D).step(1, 0).onKey(D).step(1, 0).onKey(D).velocity(1, 1));
  const Probe wall("wall", nullptr, Vector(31, 10));
  p_doomed->on_event = [&](Probe& self, const Event&) {
    player().setControls(Controls());
    delete &self;
  };
  press(D);
  EXPECT_EQ(player().getObject(), nullptr);
  press(D);
  EXPECT_EQ(player().facts().steering.p_table, nullptr);
}

TEST_F(DeclaredControls, ControlsMoveThePlayersCurrentObject) {
  player().setControls(arrows());
  Probe other("other", nullptr, Vector(40, 5));
  player().setObject(&other);
  press(RIGHTARROW);
  expectAt(ship, 10, 10);
  expectAt(other, 41, 5);
}

TEST_F(DeclaredControls, SteeringFactsAreExactAndIncludeBlockedVelocity) {
  player().setControls(Controls().onKey(D).velocityX(1.0 / 3));
  const Probe wall("wall", nullptr, Vector(11.2, 10));
  press(D);
  const SteeringFacts facts = player().facts().steering;
  EXPECT_EQ(facts.object, ship.key());
  EXPECT_EQ(facts.position, (FixedVector{fromCells(10), fromCells(10)}));
  EXPECT_EQ(facts.velocity.x, *toFixed(1.0 / 3));  // the velocity that is tried, although the ship is blocked
  ASSERT_NE(facts.p_table, nullptr);
  EXPECT_EQ(*facts.p_table, *Controls().onKey(D).velocityX(1.0 / 3).table());
}

TEST_F(DeclaredControls, InvalidControlTablesAreRefusedAndCounted) {
  ASSERT_EQ(player().setControls(arrows()), 0);
  Controls many;
  for (int i = 0; i < 33; ++i) many.onKey(A).step(1, 0);
  for (const Controls& bad :
       {Controls().onKey(A).step(NAN, 0), Controls().onKey(A).drive(0, 1025), Controls().every(3),
        Controls().onKey(A).step(1, 0).every(-1), Controls().onKey(A).step(1, 0).every(1, 8),
        Controls().onKey(A).step(1, 0).every(9001), Controls().releaseAfter(-1), Controls().step(1, 0),
        Controls().onKey(static_cast<Key>(kKeyCount)).step(1, 0), Controls().within(Box(Vector(), -1, 1)),
        Controls().onKey(A, UNDEFINED_KEYBOARD_ACTION).step(1, 0), Controls().onKey(A).drive(1, 0).every(2),
        many}) {
    EXPECT_EQ(player().setControls(bad), -1);
  }
  EXPECT_EQ(world.log().refusals(), 13u);
  press(RIGHTARROW);
  expectAt(ship, 11, 10);  // the previous table still applies
  EXPECT_EQ(player().setControls(Controls()), 0);
  press(RIGHTARROW);
  expectAt(ship, 11, 10);
}

}  // namespace
}  // namespace df::test
