#include "engine/events/EventMouse.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/world/EventPlayer.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Players : public WorldTest {
 protected:
  Players() : listener("listener", &received) {
    listener.setSolidness(SPECTRAL);
    for (const std::string& type : {JOIN_EVENT, LEAVE_EVENT, KEYBOARD_EVENT, MSE_EVENT}) {
      listener.registerInterest(type);
    }
  }
  Probe listener;
};

TEST_F(Players, JoinReturnsAnIdAndSendsEventNextTick) {
  const std::uint32_t ann = world.input().join("ann", RED);
  const std::uint32_t bob = world.input().join("bob", GREEN);
  EXPECT_EQ(ann, 1u);
  EXPECT_EQ(bob, 2u);
  EXPECT_EQ(WM.getPlayer(ann), nullptr);
  std::vector<std::uint32_t> in_event;
  listener.on_event = [&](Probe&, const Event& e) {
    const auto id = dynamic_cast<const EventJoin&>(e).getPlayer();
    EXPECT_NE(WM.getPlayer(id), nullptr);
    EXPECT_EQ(world.input().player(), id);
    in_event.push_back(id);
  };
  GM.tick();
  EXPECT_EQ(in_event, (std::vector{ann, bob}));
  EXPECT_EQ(world.input().player(), 0u);
  ASSERT_EQ(WM.getPlayers().size(), 2u);
  EXPECT_EQ(WM.getPlayer(ann)->getName(), "ann");
  EXPECT_EQ(WM.getPlayer(ann)->getColor(), RED);
  EXPECT_EQ(world.input().join("eve", BLUE, 7), 7u);
  EXPECT_EQ(world.input().join("zoe", RED), 8u);
}

TEST_F(Players, PlayerExistsUntilJustAfterTheLeaveEvent) {
  const std::uint32_t ann = joined("ann");
  world.input().leave(ann);
  world.input().key(ann, Keyboard::A, KEY_PRESSED);  // after leaving: ignored
  bool seen = false;
  listener.on_event = [&](Probe&, const Event& e) {
    seen = WM.getPlayer(dynamic_cast<const EventLeave&>(e).getPlayer()) != nullptr;
  };
  GM.tick();
  EXPECT_TRUE(seen);
  EXPECT_EQ(WM.getPlayer(ann), nullptr);
  world.input().leave(ann);
  left(77);
  EXPECT_EQ(received, (Received{"listener:df-join", "listener:df-leave"}));
  EXPECT_EQ(world.input().join("eve", RED), ann + 1);
}

TEST_F(Players, InputFollowsTheStepEventInArrivalOrder) {
  listener.registerInterest(STEP_EVENT);
  const std::uint32_t ann = joined("ann");
  received.clear();
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 3, 4);
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  left(ann);
  EXPECT_EQ(received,
            (Received{"listener:df-step", "listener:df-mouse", "listener:df-keyboard", "listener:df-leave"}));
}

TEST_F(Players, KeyEventsNameTheirPlayer) {
  const std::uint32_t ann = joined("ann");
  const std::uint32_t bob = joined("bob");
  std::vector<std::uint32_t> from;
  listener.on_event = [&](Probe&, const Event& e) {
    const auto& k = dynamic_cast<const EventKeyboard&>(e);
    EXPECT_EQ(k.getKey(), Keyboard::SPACE);
    EXPECT_EQ(k.getKeyboardAction(), KEY_DOWN);
    EXPECT_EQ(world.input().player(), k.getPlayer());
    from.push_back(k.getPlayer());
  };
  world.input().key(bob, Keyboard::SPACE, KEY_DOWN);
  world.input().key(ann, Keyboard::SPACE, KEY_DOWN);
  world.input().key(99, Keyboard::SPACE, KEY_DOWN);
  for (const int key : {-1, 9999}) world.input().key(ann, static_cast<Keyboard::Key>(key), KEY_DOWN);
  world.input().key(ann, Keyboard::SPACE, static_cast<EventKeyboardAction>(9));
  GM.tick();
  EXPECT_EQ(from, (std::vector{bob, ann}));
}

TEST_F(Players, MousePositionIsInWorldCoordinates) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  const std::uint32_t ann = joined("ann");
  PlacedObject ship(Vector(200.5, 100));
  WM.getPlayer(ann)->setObject(&ship);
  Vector seen;
  listener.on_event = [&](Probe&, const Event& e) {
    seen = dynamic_cast<const EventMouse&>(e).getMousePosition();
  };
  world.input().mouse(ann, MOVED, Mouse::UNDEFINED_MOUSE_BUTTON, 3, 4);
  world.input().mouse(ann, MOVED, Mouse::UNDEFINED_MOUSE_BUTTON, 80, 4);  // outside the view
  world.input().mouse(ann, MOVED, Mouse::UNDEFINED_MOUSE_BUTTON, 3, -1);
  GM.tick();
  // The view's corner is at (160.5, 88), so its first column shows cell 161.
  EXPECT_EQ(seen, Vector(164, 92));
  EXPECT_EQ(received, (Received{"listener:df-join", "listener:df-mouse"}));
}

TEST_F(Players, PlayersWithoutObjectShareTheWorldsView) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  const std::uint32_t ann = joined("ann");
  WM.setView(Box(Vector(50, 60), 80, 24));
  EXPECT_EQ(WM.getPlayer(ann)->getViewCorner(), Vector(50, 60));
  listener.on_event = [](Probe&, const Event&) { WM.setView(Box(Vector(70, 60), 80, 24)); };
  pressedBy({ann}, Keyboard::A);
  EXPECT_EQ(WM.getView().getCorner(), Vector(70, 60));
  EXPECT_EQ(world.views().player(joined("bob"))->getViewCorner(), Vector(70, 60));
}

TEST_F(Players, InputHandlersSeeThePlayersView) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  const std::uint32_t ann = joined("ann");
  PlacedObject ship(Vector(240, 112));
  WM.getPlayer(ann)->setObject(&ship);
  Vector during;
  listener.on_event = [&](Probe&, const Event&) {
    during = WM.getView().getCorner();
    WM.setViewPosition(Vector(300, 112));
  };
  pressedBy({ann}, Keyboard::A);
  EXPECT_EQ(during, Vector(200, 100));
  EXPECT_EQ(WM.getPlayer(ann)->getViewCorner(), Vector(260, 100));
  EXPECT_EQ(WM.getView().getCorner(), Vector(0, 0));
}

TEST_F(Players, ViewFollowsTheObjectOnlyWhenItMoves) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  const std::uint32_t ann = joined("ann");
  const Player& player = *WM.getPlayer(ann);
  auto* p_ship = new Object;
  p_ship->setSolidness(SPECTRAL);
  p_ship->setPosition(Vector(240, 112));
  EXPECT_EQ(WM.getPlayer(ann)->setObject(p_ship), 0);
  EXPECT_EQ(player.getViewCorner(), Vector(200, 100));
  p_ship->setPosition(Vector(400, 112));
  EXPECT_EQ(player.getViewCorner(), Vector(200, 100));
  WM.moveObject(p_ship, Vector(250, 112));  // within the view's inner third
  EXPECT_EQ(player.getViewCorner(), Vector(200, 100));
  p_ship->setVelocity(Vector(30, 0));
  WM.update();  // x = 280, outside the inner third
  EXPECT_NEAR(player.getViewCorner().x(), 280 - 80.0 * 2 / 3, 1e-6);
  const Vector before = player.getViewCorner();
  delete p_ship;
  EXPECT_EQ(player.getObject(), nullptr);
  EXPECT_EQ(player.getViewCorner(), before);
  EXPECT_EQ(WM.getView().getCorner(), Vector(0, 0));
}

TEST_F(Players, WorldsViewFollowsAndIsClamped) {
  WM.setBoundary(Box(Vector(0, 0), 200, 50));
  Object ship;
  ship.setSolidness(SPECTRAL);
  ship.setPosition(Vector(100, 25));
  EXPECT_EQ(WM.setViewFollowing(&ship), 0);
  EXPECT_EQ(WM.getView(), Box(Vector(60, 13), 80, 24));
  WM.moveObject(&ship, Vector(199, 49));
  EXPECT_EQ(WM.getView().getCorner(), Vector(120, 26));
  EXPECT_EQ(WM.setViewFollowing(nullptr), 0);
  WM.moveObject(&ship, Vector(0, 0));
  EXPECT_EQ(WM.getView().getCorner(), Vector(120, 26));
}

TEST_F(Players, ObjectOfAnotherWorldIsRefused) {
  const std::uint32_t ann = joined("ann");
  World other;
  const World::Scope scope_of_other(other);
  Object there;
  EXPECT_EQ(world.views().player(ann)->setObject(&there), -1);
  EXPECT_EQ(world.views().follow(nullptr, &there), -1);
}

TEST_F(Players, TextsAreCheckedAndShownToOnePlayerOnly) {
  const std::uint32_t ann = joined("ann");
  const std::uint32_t bob = joined("bob");
  Player& player = *WM.getPlayer(ann);
  EXPECT_EQ(player.setText(0, Vector(2, 1), "hi \xC3\xA4\x07", YELLOW), 0);
  EXPECT_EQ(player.setText(16, Vector(2, 1), "x"), -1);
  EXPECT_EQ(player.setText(1, Vector(80, 1), "x"), -1);
  EXPECT_EQ(player.setText(1, Vector(2, -1), "x"), -1);
  EXPECT_EQ(player.setText(1, Vector(2, 1), "x", static_cast<Color>(8)), -1);
  EXPECT_EQ(player.setText(1, Vector(78, 2), "long"), 0);  // truncated at the window's edge
  ASSERT_EQ(player.facts().texts.size(), 2u);
  EXPECT_EQ(player.facts().texts[1].text, "lo");
  GM.tick();
  EXPECT_EQ(world.picture().renderPlayer(ann).rowText(1).substr(0, 8), "  hi \xC3\xA4?");
  EXPECT_EQ(world.picture().renderPlayer(ann).at(2, 1).color, YELLOW);
  EXPECT_EQ(countDifferences(world.picture().renderPlayer(bob), world.picture().renderPlayer(0)), 0);
  player.setText(0, Vector(2, 1), "");
  player.setText(1, Vector(2, 1), "");
  EXPECT_TRUE(player.facts().texts.empty());
  EXPECT_EQ(world.log().refusals(), 4u);
  EXPECT_EQ(logged("setText"), 1);
}

TEST_F(Players, WindowSizeHasLimits) {
  EXPECT_EQ(DM.getHorizontal(), 80);
  EXPECT_EQ(DM.getVertical(), 24);
  EXPECT_EQ(DM.setSize(19, 24), -1);
  EXPECT_EQ(DM.setSize(80, 151), -1);
  EXPECT_EQ(DM.setSize(400, 150), 0);
  EXPECT_EQ(WM.getBoundary(), Box(Vector(0, 0), 400, 150));
  EXPECT_EQ(WM.getView(), Box(Vector(0, 0), 400, 150));
  WM.setBoundary(Box(Vector(0, 0), 50, 50));
  DM.setSize(100, 30);
  EXPECT_EQ(WM.getBoundary(), Box(Vector(0, 0), 50, 50));
  EXPECT_EQ(logged("setSize"), 1);
  EXPECT_EQ(world.log().refusals(), 2u);
  EXPECT_EQ(WM.setBoundary(Box(Vector(0, 0), -1, 50)), -1);
}

TEST_F(Players, ViewFollowingAnotherKeepsThePlayersObject) {
  const std::uint32_t id = joined("ann");
  Player& player = *WM.getPlayer(id);
  Object ship;
  Object sight;
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  sight.setPosition(Vector(250, 250));
  player.setObject(&ship);
  listener.on_event = [&](Probe&, const Event&) { WM.setViewFollowing(&sight); };
  pressedBy({id}, Keyboard::F);
  EXPECT_EQ(player.getObject(), &ship);
  EXPECT_EQ(player.facts().followed, sight.key());
  EXPECT_EQ(player.getViewCorner(), Vector(210, 238));
}

}  // namespace
}  // namespace df::test
