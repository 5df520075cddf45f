// Players of a game that calls GM.run() several times (runs/game.cpp): they stay connected until its last run
// has ended. Real processes and sockets.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <memory>

#include "ProgramFixture.h"

namespace naiad::test {
namespace {

class Runs : public ProgramFixture {
 protected:
  bool isPlaying(TestClient& client) const override { return isIn(client, 1); }
  /// True if the client is connected and shows this act.
  static bool isIn(TestClient& client, int act) {
    return client.joined() && has(row(client), ";") && numberAfter(row(client), "act=") == act;
  }
  static bool isOver(TestClient& client) { return client.connection().isOver(); }
};

TEST_F(Runs, PlayersStayConnectedFromTheFirstToTheLast) {
  struct {
    const char* name;
    const char* steps;  // of main(), see runs/game.cpp
    int acts;
  } const rows[] = {{"one run", "r", 1},
                    {"a title", "rr", 2},
                    {"a title and an epilogue", "rrr", 3},
                    {"a splash of the engine", "err", 2},
                    {"a splash of its own", "srr", 3},
                    {"a title that ends at a key", "kr", 2},
                    {"a pause", "rpr", 2},
                    {"a world cleared by hand", "rcr", 2},
                    {"a world shut down", "rwr", 2},
                    {"managers started again", "rgrgr", 3},
                    {"all of it", "serpcrwpr", 4}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    clients.clear();
    ASSERT_NO_FATAL_FAILURE(launch(
        "runs_game", {{"RUNS", row.steps}, {"NAIAD_ON_GAME_OVER", row.steps[0] == 'k' ? "exit" : "leave"}}));
    auto ann = join("ann");
    auto bob = join("bob");
    const std::uint32_t player = ann->player();
    for (int act = 1; act <= row.acts; ++act) {
      ASSERT_TRUE(serve([&] { return isOver(*ann) || (isIn(*ann, act) && isIn(*bob, act)); }));
      ASSERT_FALSE(isOver(*ann)) << "act " << act << ": " << ann->connection().message() << "\n"
                                 << game->log();
      if (act > 1) {
        EXPECT_TRUE(serve([&] { return has(Runs::row(*ann), "joins=2;"); })) << Runs::row(*ann);
      }
      EXPECT_EQ(ann->player(), player);
      EXPECT_TRUE(serve([&] { return lists(*ann, "bob"); }));
      if (act > 1 || row.steps[0] != 's') press(*bob, df::Keyboard::SPACE);
    }
    ASSERT_TRUE(serve([&] { return isOver(*ann) && isOver(*bob); })) << game->log();
    EXPECT_EQ(ann->connection().message(), "The game is over.");
    EXPECT_EQ(game->wait(), 0) << game->log();
    EXPECT_FALSE(has(game->log(), "reconnected"));
    EXPECT_EQ(has(game->log(), "listens on"), true);
  }
}

// A player that leaves or joins while no run is active has done so when the next one begins.
TEST_F(Runs, LeavingAndJoiningInAPauseTakesEffect) {
  launch("runs_game", {{"RUNS", "rpr"}});
  auto ann = join("ann");
  auto bob = join("bob");
  press(*ann, df::Keyboard::SPACE);
  bob->connection().leave();
  auto cid = std::make_unique<TestClient>(context, game->port(), home.player("cid"));
  clients.push_back(cid.get());
  ASSERT_TRUE(serve([&] { return cid->joined() && isIn(*ann, 2) && isIn(*cid, 2); })) << game->log();
  EXPECT_TRUE(serve([&] { return lists(*ann, "cid") && !lists(*ann, "bob"); }));
}

}  // namespace
}  // namespace naiad::test
