// The pause of a game with players: which players decide, and which messages they read.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/widgets/Pause.h"

namespace naiad::test {
namespace {

bool reads(TestClient& client, const std::string& line) {
  const auto& chat = client.session().chat();
  return std::ranges::any_of(
      chat, [&line](const ChatEntry& entry) { return entry.text == line && entry.name.empty(); });
}

void pressP(TestClient& client) {
  client.session().sendKey(df::Keyboard::P, df::KEY_PRESSED, std::chrono::steady_clock::now());
}

class PausePlay : public testing::Test {
 protected:
  void start(const std::string& players) {
    HostOptions options = fastOptions();
    options.players = players;
    server.emplace([](df::World&) { new df::Pause(df::Keyboard::P); }, options);
    ann.emplace(context, server->port(), "ann");
    ASSERT_TRUE(serveUntil(context, {&*ann}, [this] { return ann->joined(); }));
    bob.emplace(context, server->port(), "bob");
    ASSERT_TRUE(until([this] { return bob->joined(); }));
  }
  bool until(const std::function<bool()>& done) { return serveUntil(context, {&*ann, &*bob}, done); }
  bool isPaused() {
    return server->inWorld([](df::World& world) { return world.isPaused(); });
  }

  asio::io_context context;
  std::optional<TestServer> server;
  std::optional<TestClient> ann, bob;
};

TEST_F(PausePlay, PauseIsAVoteShownToAllPlayers) {
  start("together");
  pressP(*ann);
  ASSERT_TRUE(until([this] { return reads(*ann, "pause: 1 of 2") && reads(*bob, "pause: 1 of 2"); }));
  EXPECT_FALSE(isPaused());
  pressP(*bob);
  ASSERT_TRUE(until([this] { return reads(*ann, "pause: 2 of 2"); }));
  EXPECT_TRUE(isPaused());
}

TEST_F(PausePlay, WatchedPlayerPausesWithoutAVote) {
  start("first");
  pressP(*bob);  // bob only watches
  pressP(*ann);
  ASSERT_TRUE(until([this] { return isPaused(); }));
  EXPECT_FALSE(reads(*ann, "pause: 1 of 2"));
}

}  // namespace
}  // namespace naiad::test
