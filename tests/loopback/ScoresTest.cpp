// Scores of a game in processes of its own (rounds/game.cpp), from one round to the next and from one server
// to the next. Real processes and sockets.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "GameProgram.h"
#include "Home.h"
#include "RunCtl.h"
#include "TestClient.h"

namespace naiad::test {
namespace {

class Scores : public testing::Test {
 protected:
  void start() {
    game.reset();
    game = std::make_unique<GameProgram>(
        "rounds_game", std::map<std::string, std::string>{{"NAIAD_ON_GAME_OVER", "restart"},
                                                          {"NAIAD_STATE", home.identity("state")}});
    ASSERT_NE(game->port(), 0) << game->log();
  }
  void join() {
    client = std::make_unique<TestClient>(context, game->port(), home.player("ann"));
    ASSERT_TRUE(serve([&] { return client->joined(); })) << game->log();
  }
  bool serve(const std::function<bool()>& done) { return serveUntil(context, {client.get()}, done); }
  bool shows(const std::string& text) {
    return serve([&] {
      return client->joined() &&
             client->session().replica().render(client->newestTick()).rowText(12).find(text) !=
                 std::string::npos;
    });
  }
  void press(df::Keyboard::Key key) {
    client->session().sendKey(key, df::KEY_PRESSED, std::chrono::steady_clock::now());
  }
  /// As dfctl lists them on disk.
  std::string listed() const {
    return runCtl("--control " + game->control().string() + " scores --json").second;
  }

  Home home;
  asio::io_context context;
  std::unique_ptr<GameProgram> game;
  std::unique_ptr<TestClient> client;
};

TEST_F(Scores, TheNextRoundKnowsThemAndSoDoesTheNextServerAfterAKill) {
  start();
  join();
  ASSERT_TRUE(shows("best=-1;"));
  for (int i = 0; i < 3; ++i) press(df::Keyboard::RIGHTARROW);
  press(df::Keyboard::S);
  ASSERT_TRUE(shows("best=3;")) << game->log();
  press(df::Keyboard::X);
  EXPECT_TRUE(shows("steps=0 ")) << "another round";
  EXPECT_TRUE(shows("best=3;")) << game->log();
  const std::string list = listed();
  EXPECT_NE(list.find(R"("table":"steps","place":1,"name":"walker","points":3)"), std::string::npos) << list;

  game->signal(SIGKILL);
  game->wait();
  client.reset();
  start();
  join();
  EXPECT_TRUE(shows("best=3;")) << game->log();
  EXPECT_EQ(listed(), list) << "none twice, none lost";
}

TEST_F(Scores, TheLogCountsThem) {
  start();
  join();
  press(df::Keyboard::S);
  ASSERT_TRUE(shows("best=0;")) << game->log();
  game->signal(SIGTERM);
  game->wait();
  EXPECT_NE(game->log().find("scores=1 scores_written=1"), std::string::npos) << game->log();
}

}  // namespace
}  // namespace naiad::test
