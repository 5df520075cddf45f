// Scores of a game in processes of its own (rounds/game.cpp) are kept from round to round and from server to
// server. Real processes and sockets.
#include <gtest/gtest.h>
#include <signal.h>

#include <memory>
#include <string>
#include <utility>

#include "ProgramFixture.h"
#include "RecoveryRun.h"
#include "RoomsFixture.h"

namespace naiad::test {
namespace {

class Scores : public ProgramFixture {
 protected:
  void start() {
    launch("rounds_game", {{"NAIAD_ON_GAME_OVER", "restart"}, {"NAIAD_STATE", home.identity("state")}});
  }
  void join() {
    clients.clear();
    client = ProgramFixture::join("ann");
  }
  bool shows(const std::string& text) {
    return serve([&] { return client->joined() && has(row(*client), text); });
  }
  /// Returns the scores on disk as listed by dfctl.
  std::string listed() const { return game->ctl("scores --json").second; }

  std::unique_ptr<TestClient> client;
};

TEST_F(Scores, ScoresSurviveRoundsAndServerKills) {
  start();
  join();
  ASSERT_TRUE(shows("best=-1;"));
  for (int i = 0; i < 3; ++i) press(*client, df::Keyboard::RIGHTARROW);
  press(*client, df::Keyboard::S);
  ASSERT_TRUE(shows("best=3;")) << game->log();
  press(*client, df::Keyboard::X);
  EXPECT_TRUE(shows("steps=0 ")) << "another round";
  EXPECT_TRUE(shows("best=3;")) << game->log();
  const std::string list = listed();
  EXPECT_TRUE(has(list, R"("table":"steps","place":1,"name":"walker","points":3)"));

  game->end(SIGKILL);
  client.reset();
  start();
  join();
  EXPECT_TRUE(shows("best=3;")) << game->log();
  EXPECT_EQ(listed(), list) << "none twice, none lost";
}

class RoomScores : public RoomsFixture {
 protected:
  std::pair<int, std::string> scores(const std::string& words) const { return game->ctl("scores " + words); }
  std::string replay(const std::string& recording, const std::string& words) const {
    return runProgram(std::string(NAIAD_BINARY_DIR) + "/dfreplay " + home.identity("rounds").string() + "/" +
                      recording + " --game " + kScoresModule + " " + words + " 2>&1")
        .second;
  }
  /// Returns the number after "keys=" in the picture: the keys that the game has received; -1 if missing.
  static int keysIn(const std::string& picture) { return numberAfter(picture, "keys=").value_or(-1); }
  /// Returns the value of the key `name` in JSON text, without quotes.
  static std::string valueIn(const std::string& json, const std::string& name) {
    const std::string key = "\"" + name + "\":";
    const std::size_t at = json.find(key);
    if (at == std::string::npos) return "";
    const std::size_t begin = json.find_first_not_of('"', at + key.size());
    return json.substr(begin, json.find_first_of(",}\"", begin) - begin);
  }
};

TEST_F(RoomScores, ScoreIsFoundAtItsTickInTheRecording) {
  start({"one", std::string("two=") + kScoresModule, "doors=lobby"}, {},
        {{"NAIAD_STATE", home.identity("state")}, {"NAIAD_JOURNAL", home.identity("rounds")}});
  auto ann = connect("ann", "two");
  const auto has_pressed = [&](int keys) {
    return serve([&] {
      return ann->joined() && row(*ann).find("keys=" + std::to_string(keys) + ";") != std::string::npos;
    });
  };
  ASSERT_TRUE(has_pressed(0)) << game->log();
  for (int i = 0; i < 6; ++i) press(*ann, df::Keyboard::X);
  ASSERT_TRUE(has_pressed(6)) << game->log();
  const auto [code, listed] = scores("--room two --json");
  EXPECT_EQ(code, 0) << listed;
  EXPECT_TRUE(has(listed, R"("table":"even","place":1,"name":"counter","points":6)"));
  const std::string recording = valueIn(listed, "recording");
  const std::string tick = valueIn(listed, "tick");
  const std::string number = valueIn(listed, "number");
  EXPECT_TRUE(recording.starts_with("two/scores_module-")) << listed;
  game->end(SIGTERM);
  const std::string added = replay(recording, "--scores");
  EXPECT_TRUE(has(added, "tick=" + tick + " number=" + number + " table=even name=\"counter\" points=6\n"))
      << listed;
  const std::string shown = replay(recording, "--text " + tick);
  EXPECT_GE(keysIn(shown), 6) << listed << shown;
  EXPECT_LT(keysIn(replay(recording, "--text " + std::to_string(std::stoi(tick) - 1))), 6)
      << "it came in that tick";
}

TEST_F(RoomScores, SeveralGamesRequireAGameOrRoomOption) {
  start({"one", "two", "doors=lobby"}, {}, {{"NAIAD_STATE", home.identity("state")}});
  const auto expectRefusal = [&](const std::string& words, const std::string& sentence) {
    const auto [code, said] = scores(words);
    EXPECT_EQ(code, 1) << words;
    EXPECT_TRUE(has(said, sentence)) << words << ": ";
  };
  expectRefusal("", "--game room_module  (rooms one, two)\n  --game lobby  (room doors)\n");
  expectRefusal("keys 3", "choose one with --game or --room");
  expectRefusal("--game loby", "did you mean \"lobby\"?");
  expectRefusal("--game=zzz", "Games: room_module, lobby.");
  expectRefusal("--room zzz", "Rooms: one, two, doors.");
  expectRefusal("--room one --game lobby", "not both");
  EXPECT_EQ(scores("--room two"), scores("--game room_module"));
  EXPECT_EQ(scores("keys 3 --game lobby"), std::pair(0, std::string("No scores.\n")));
  EXPECT_EQ(scores("--rom one").first, 2);
}

}  // namespace
}  // namespace naiad::test
