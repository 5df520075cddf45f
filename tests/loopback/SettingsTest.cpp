// The settings that a game requests: how its clients get them, and which players may end the game.
#include <gtest/gtest.h>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/events/EventKeyboard.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/GameManager.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"

namespace naiad::test {
namespace {

std::chrono::microseconds tickToldWith(int frame_time_millis, int frame_micros) {
  HostOptions options = fastOptions();
  options.frame_micros = frame_micros;
  TestServer server([=](df::World& world) { world.extras().settings.frame_time = frame_time_millis; },
                    options);
  asio::io_context context;
  TestClient client(context, server.port(), "ann");
  EXPECT_TRUE(serveUntil(context, {&client}, [&] { return client.joined(); }));
  return client.session().welcome().tick;
}

TEST(Settings, WelcomeHasFrameTimeOfGameOrHost) {
  EXPECT_EQ(tickToldWith(5, 0), std::chrono::milliseconds(5));
  EXPECT_EQ(tickToldWith(50, 3000), std::chrono::milliseconds(3)) << "the host's own counts more";
  EXPECT_EQ(tickToldWith(33, 0), std::chrono::microseconds(33333))
      << "33 is how the published engine writes 1/30 s";
  EXPECT_EQ(tickToldWith(999999, 0), std::chrono::seconds(1)) << "clients believe no longer one";
}

TEST(Settings, BackgroundChangesReachClients) {
  TestServer server([](df::World&) { DM.setBackgroundColor(df::BLUE); });
  asio::io_context context;
  TestClient client(context, server.port(), "ann");
  const auto shows = [&](df::Color color) {
    return serveUntil(context, {&client},
                      [&] { return client.joined() && client.session().replica().background() == color; });
  };
  EXPECT_TRUE(shows(df::BLUE));
  server.inWorld([](df::World& world) {
    const df::World::Scope scope(world);
    return DM.setBackgroundColor(df::RED);
  });
  EXPECT_TRUE(shows(df::RED));
}

/// Q ends the game, like in most games.
struct Quitter : df::Object {
  Quitter() {
    setSolidness(df::SPECTRAL);
    registerInterest(df::KEYBOARD_EVENT);
  }
  int eventHandler(const df::Event* p_event) override {
    const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_event);
    if (p_key != nullptr && p_key->getKey() == df::Keyboard::Q) GM.setGameOver();
    return 1;
  }
};

TEST(Settings, GameOverKeyEndsTheGameForOnePlayer) {
  TestServer server([](df::World&) { new Quitter; });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.joined() && bob.joined(); }));
  bob.session().sendKey(df::Keyboard::Q, df::KEY_PRESSED, std::chrono::steady_clock::now());
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return bob.connection().state() == Connection::State::kEnded; }));
  EXPECT_EQ(bob.connection().message(), "The game is over for you.");
  const std::uint32_t then = ann.newestTick();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.newestTick() > then + 20; }));
  EXPECT_EQ(server.inWorld([](df::World& world) { return world.views().getPlayers().size(); }), 1u);
  ann.session().sendKey(df::Keyboard::Q, df::KEY_PRESSED, std::chrono::steady_clock::now());
  ASSERT_TRUE(
      serveUntil(context, {&ann}, [&] { return ann.connection().state() == Connection::State::kEnded; }));
  EXPECT_FALSE(server.inWorld([](df::World& world) { return world.isGameOver(); })) << "the server stays";
}

}  // namespace
}  // namespace naiad::test
