// Clients show the pictures of the server's own display, cell for cell, over real sockets.
#include <gtest/gtest.h>

#include <algorithm>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/widgets/ViewObject.h"
#include "engine/world/Capture.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Views.h"

namespace naiad::test {
namespace {

using Loopback = LoopbackFixture;

TEST_F(Loopback, ClientMatchesTheServerForAThousandTicks) {
  TestServer server(busyWorld(200));
  TestClient client(context, server.port(), "ann");
  std::uint32_t pressed = 0;
  ASSERT_TRUE(serve(client, [&] {
    // Presses keys, so that the player's own text and ship change.
    if (client.joined() && client.newestTick() > pressed + 10) {
      pressed = client.newestTick();
      const auto key = pressed % 3 == 0 ? df::Keyboard::LEFTARROW : df::Keyboard::RIGHTARROW;
      client.session().sendKey(key, df::KEY_PRESSED, std::chrono::steady_clock::now());
    }
    return client.pictures().size() >= 1000;
  }));
  expectSame(client, server, 1000);
  const std::string last = client.pictures().rbegin()->second.text();
  EXPECT_TRUE(has(last, "keys "));
  // Another object may cover the ship in some pictures.
  const auto shown = std::ranges::count_if(
      client.pictures(), [](const auto& each) { return each.second.text().find('@') != std::string::npos; });
  EXPECT_GT(shown, 500) << last;
}

/// Shakes the window for ten of every thirty ticks.
struct Shaker : df::Object {
  Shaker() {
    setSolidness(df::SPECTRAL);
    registerInterest(df::STEP_EVENT);
  }
  int eventHandler(const df::Event* p_event) override {
    const int step = dynamic_cast<const df::EventStep*>(p_event)->getStepCount();
    if (step % 30 == 0) DM.shake(40, 40, 10);
    return 1;
  }
};

TEST_F(Loopback, ScreenShakeReachesTheClient) {
  int shaken = 0;
  TestServer server([](df::World& world) {
    populateBusyWorld(world, 60);
    new Shaker;
  });
  TestClient client(context, server.port(), "ann");
  ASSERT_TRUE(serve(client, [&] {
    if (client.joined())
      shaken += server.inWorld([](df::World& world) { return world.picture().view().shake_x != 0 ? 1 : 0; });
    return client.pictures().size() >= 200;
  }));
  expectSame(client, server, 200);
  EXPECT_GT(shaken, 0);
}

/// Flies to the right through a world larger than its player's view, which follows it.
struct Scout : df::Object {
  explicit Scout(df::Vector at) {
    setSolidness(df::SPECTRAL);
    setPosition(at);
    setVelocity(df::Vector(0.4, 0.1));
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::CYAN); }
};

/// Gives each player a Scout far from the others, and shows their number in a frame on the view.
struct Scouts : df::ViewObject {
  Scouts() {
    setViewString("Scouts");
    registerInterest(df::JOIN_EVENT);
  }
  int eventHandler(const df::Event* p_event) override {
    const auto* p_join = dynamic_cast<const df::EventJoin*>(p_event);
    if (p_join == nullptr) return df::ViewObject::eventHandler(p_event);
    setValue(getValue() + 1);
    const auto number = static_cast<double>(p_join->getPlayer());
    WM.getPlayer(p_join->getPlayer())->setObject(new Scout(df::Vector(200 * number, 60)));
    return 1;
  }
};

TEST_F(Loopback, ViewObjectsAreInEveryPlayersOwnView) {
  TestServer server([](df::World& world) {
    world.views().setBoundary(df::Box(df::Vector(), 2000, 400));
    for (int i = 0; i < 60; ++i) new Scout(df::Vector(20 * i, 50 + i % 20));
    new Scouts;
  });
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return ann.pictures().size() > 150 && bob.pictures().size() > 150; }));
  expectSame(ann, server, 150);
  expectSame(bob, server, 150);
  for (TestClient* client : {&ann, &bob})
    EXPECT_TRUE(has(client->pictures().rbegin()->second.rowText(1), "| Scouts 2 |"))
        << client->pictures().rbegin()->second.text();
}

}  // namespace
}  // namespace naiad::test
