// A server is killed while clients play. Its next start resumes the round, and all clients return as the
// players that they were, in their rooms and under their ids. `deploy/bench recovery` does this a thousand
// times.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "RecoveryRun.h"
#include "RoomsFixture.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/UnfinishedRound.h"
#include "host/rounds/RoundJournals.h"
#include "tests/support/Processes.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

class KilledServer : public testing::TestWithParam<const char*> {};

TEST_P(KilledServer, LosesNoPlayersAndNoTicks) {
  std::mt19937_64 random(7);
  RecoveryRun run(GetParam(), 2, random());
  for (int i = 0; i < (kSanitized ? 2 : 5); ++i) {
    run.play(std::chrono::milliseconds(100 + random() % 900));
    ASSERT_TRUE(run.playUntilPictured()) << i;
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
    EXPECT_EQ(result.ticks_lost, 0u) << i << ": " << result.problem;
    EXPECT_GT(result.cells, 0u) << i;
    EXPECT_EQ(result.wrong_cells, 0u) << i << " of " << result.cells << ": " << result.problem;
    RecordProperty("took_ms_" + std::to_string(i), static_cast<int>(result.took.count()));
    if (HasFailure()) return;
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
}

// The long form is `deploy/bench recovery`, with a hundred kills.
TEST(Recovery, ScoresSurviveKillsAndMatchTheRound) {
  RecoveryRun run(kScoresModule, 2, 11);
  for (int i = 0; i < 2; ++i) {
    run.play(std::chrono::milliseconds(400));
    ASSERT_TRUE(run.playUntilPictured()) << i;
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
  }
  run.play(std::chrono::milliseconds(300));
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
  const ScoreCheck check = run.checkScores();
  EXPECT_GT(check.kept, 0u) << run.log();
  EXPECT_EQ(check.missing, 0u) << "none is lost";
  EXPECT_EQ(check.foreign, 0u) << "none is there that the round does not add, or twice";
}

// Also the launcher, which starts all worlds.
TEST(Recovery, RoundContinuesAfterAllChildrenAreKilled) {
  RecoveryRun run("saucershoot", 2, 5);
  for (const bool reversed : {false, true}) {
    run.play(std::chrono::milliseconds(700));
    ASSERT_TRUE(run.killChildren(reversed)) << run.serverLog();
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
  EXPECT_TRUE(has(run.log(), "game recovered: a new world replayed"));
}

INSTANTIATE_TEST_SUITE_P(Games, KilledServer,
                         testing::Values("saucershoot", "breakout", "platformer", "tron"),
                         [](const auto& one) { return std::string(one.param); });

constexpr int kDoorColumn = 10;  ///< middle column of the first door
constexpr int kDoorRow = 6;
constexpr int kFirstRow = 2;  ///< row where players appear
constexpr int kRows = 24;

/// Players also walk about in the shipped lobby and into its first door.
class RoomRecovery : public RoomsFixture {
 protected:
  using Place = std::pair<int, int>;

  /// Returns the position of the first player shown in these rows; nullopt if none is there.
  static std::optional<Place> walker(TestClient& client, int first, int last) {
    const df::Canvas picture = client.session().replica().render(client.newestTick());
    for (int y = first; y <= last; ++y) {
      const std::size_t x = picture.rowText(y).find('@');
      if (x != std::string::npos) return Place(static_cast<int>(x), y);
    }
    return std::nullopt;
  }
  /// Makes one step. Waits four ticks, because the lobby allows a step only every second tick.
  void step(TestClient& client, df::Keyboard::Key key) {
    const auto before = walker(client, kFirstRow, kRows - 1);
    ASSERT_TRUE(before);
    press(client, key);
    ASSERT_TRUE(serve([&] { return walker(client, kFirstRow, kRows - 1) != before; }));
    const std::uint32_t moved = client.newestTick();
    ASSERT_TRUE(serve([&] { return client.newestTick() >= moved + 4; }));
  }
  /// Walks to the cell from which one more step down leads into the door.
  void walkToDoor(TestClient& client) {
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->first > kDoorColumn)
      step(client, df::Keyboard::LEFTARROW);
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->second < kDoorRow - 1)
      step(client, df::Keyboard::DOWNARROW);
  }
  /// Starts a server, always with equal options.
  void startJournaled() {
    const std::uint16_t port = game ? m_port : 0;
    game.reset();
    start(rooms, {"--reconnect-time=60", "--world-environment=ROOM_REPEATS"},
          {{"ROOM_REPEATS", "1"},
           {"NAIAD_PORT", std::to_string(port)},
           {"NAIAD_IDENTITY", home.identity("key")},
           {"NAIAD_JOURNAL", ""},  // the default: in the state folder
           {"NAIAD_STATE", home.identity("state")},
           {"DRAGONFLY_CONFIG", home.identity("none")}});
    m_port = game->port();
  }
  /// Kills the server. If it had not yet created a round's file, the next server does so from shared memory.
  void kill() {
    game->end(SIGKILL);
    m_before.clear();
    for (TestClient* p_client : clients) m_before.push_back(&p_client->session());
  }
  bool isWritten(const std::string& room) const {
    const std::vector<fs::path> files = roundsOf(room);
    if (files.empty()) return false;
    try {
      return !UnfinishedRound(files.front().string()).fact(kFactFirstTick).empty();
    } catch (const UnfinishedRoundError&) {  // the head of the file is incomplete
      return false;
    }
  }
  /// Waits until all players have a session of the new server and see their room.
  bool serveUntilBack() {
    return serve([&] {
      for (std::size_t i = 0; i < clients.size(); ++i) {
        TestClient& client = *clients[i];
        if (!client.joined() || &client.session() == m_before[i] || client.newestTick() == 0) return false;
      }
      return true;
    });
  }
  /// Returns the number of sessions that the server has resumed.
  std::size_t returned() const {
    return static_cast<std::size_t>(countIn(game->log(), "reconnected to the recovered round"));
  }
  fs::path rounds() const { return home.identity("state") / "rounds"; }
  std::vector<fs::path> roundsOf(const std::string& room) const {
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(rounds() / room, error)) found.push_back(entry.path());
    return found;
  }

  std::vector<std::string> rooms = {"one", "two", "three", "four"};

 private:
  std::uint16_t m_port = 0;
  std::vector<const ClientSession*> m_before;  ///< the clients' sessions when the server was killed
};

TEST_F(RoomRecovery, PlayersReturnToTheirRoomsWithTheirIds) {
  startJournaled();
  auto ann = join("ann", "one");
  auto bob = join("bob", "two");
  auto cid = join("cid", "one");
  cid->session().enterRoom("three");
  ASSERT_TRUE(serve([&] { return cid->session().welcome().room == "three" && shown(*cid).process > 0; }));
  type(*ann, 1);
  type(*bob, 3);
  type(*cid, 2);
  for (int kills = 1; kills <= 2 && !HasFatalFailure(); ++kills) {
    const std::vector<int> keys = {shown(*ann).keys, shown(*bob).keys, shown(*cid).keys};
    const std::vector<std::uint32_t> ids = {ann->player(), bob->player(), cid->player()};
    const int ticks = shown(*bob).ticks;
    kill();
    startJournaled();
    ASSERT_TRUE(serveUntilBack()) << game->log();
    ASSERT_TRUE(serve([&] { return returned() == 3; })) << game->log();
    ASSERT_TRUE(
        serve([&] { return shown(*ann).process > 0 && shown(*bob).process > 0 && shown(*cid).process > 0; }));
    EXPECT_EQ((std::vector<int>{shown(*ann).keys, shown(*bob).keys, shown(*cid).keys}), keys);
    EXPECT_EQ((std::vector<std::uint32_t>{ann->player(), bob->player(), cid->player()}), ids);
    EXPECT_EQ(ann->session().welcome().room, "one");
    EXPECT_EQ(bob->session().welcome().room, "two");
    EXPECT_EQ(cid->session().welcome().room, "three");
    EXPECT_GE(shown(*bob).ticks, ticks) << "no tick that was seen is lost";
    type(*bob, 1);
  }
  ASSERT_TRUE(serve([&] { return roomInList(*ann, "four") != nullptr; }));
  EXPECT_TRUE(roomInList(*ann, "four")->asleep) << "it had no round";
  auto dan = join("dan", "two");
  EXPECT_GT(dan->player(), std::max({ann->player(), bob->player(), cid->player()}));
  cid->session().enterRoom("two");
  EXPECT_TRUE(serve([&] {
    return cid->session().welcome().room == "two" && shown(*cid).keys == shown(*bob).keys;
  })) << game->log();
}

// A world has at most two copies, so if there are three, each room has at least one.
TEST_F(RoomRecovery, CrashedRoomResumesFromACheckpointWithoutDisturbingOthers) {
  startJournaled();
  auto ann = join("ann", "one");
  auto bob = join("bob", "two");
  type(*ann, 2);
  type(*bob, 2);
  ASSERT_TRUE(serve([&] { return processesBelow(game->process(), "df-copy").size() >= 3; })) << game->log();
  const std::size_t heard_by_bob = bob->session().chat().size();
  const ClientSession* p_ann = &ann->session();
  const ClientSession* p_bob = &bob->session();
  const int seen_by_ann = shown(*ann).ticks;
  int seen_by_bob = shown(*bob).ticks;
  press(*ann, df::Keyboard::C);
  ASSERT_TRUE(serve([&] {
    EXPECT_GE(shown(*bob).ticks, seen_by_bob);
    seen_by_bob = shown(*bob).ticks;
    return game->log().find("room one: game recovered: ") != std::string::npos &&
           shown(*ann).ticks > seen_by_ann + 50;
  })) << game->log();
  EXPECT_TRUE(has(game->log(), "room one: game recovered: a copy of its world replayed "));
  EXPECT_EQ(&ann->session(), p_ann);
  EXPECT_EQ(&bob->session(), p_bob);
  EXPECT_EQ(shown(*ann).keys, 2) << "without the one that it died of";
  EXPECT_EQ(bob->session().chat().size(), heard_by_bob);
  EXPECT_FALSE(has(game->log(), "room two: game"));
  type(*ann, 1);
  type(*bob, 1);
  kill();
  startJournaled();
  ASSERT_TRUE(serveUntilBack()) << game->log();
  ASSERT_TRUE(serve([&] { return returned() == 2; })) << game->log();
  ASSERT_TRUE(serve([&] { return shown(*ann).process > 0 && shown(*bob).process > 0; }));
  EXPECT_EQ(shown(*ann).keys, 3);
  EXPECT_EQ(shown(*bob).keys, 3);
}

// The round of the lobby includes the list of rooms that its doors need.
TEST_F(RoomRecovery, DoorsWorkAfterRecovery) {
  rooms = {"hall=lobby", "one"};
  startJournaled();
  auto ann = connect("ann", "hall");
  const auto sees_door = [&] { return ann->joined() && row(*ann, 4).find("one") != std::string::npos; };
  ASSERT_TRUE(serve(sees_door)) << game->log();
  kill();
  startJournaled();
  ASSERT_TRUE(serveUntilBack()) << game->log();
  ASSERT_TRUE(serve(sees_door));
  ASSERT_TRUE(serve([&] { return returned() == 1; })) << game->log();
  walkToDoor(*ann);
  ASSERT_FALSE(HasFatalFailure()) << game->log();
  press(*ann, df::Keyboard::DOWNARROW);
  ASSERT_TRUE(serve([&] { return ann->session().welcome().room == "one"; })) << game->log();
  EXPECT_TRUE(serve([&] { return shown(*ann).process > 0; }));
}

// The world of the lobby still knows the room, and the next server has another one in addition.
TEST_F(RoomRecovery, DoorOfARemovedRoomIsClosed) {
  rooms = {"hall=lobby", "one", "two"};
  startJournaled();
  auto ann = connect("ann", "hall");
  const auto sees = [&](int y, const std::string& text) {
    return ann->joined() && row(*ann, y).find(text) != std::string::npos;
  };
  ASSERT_TRUE(serve([&] { return sees(4, "one") && sees(4, "two"); })) << game->log();
  ASSERT_FALSE(sees(kDoorRow, "[XX]"));
  kill();
  rooms = {"hall=lobby", "two", "three"};
  startJournaled();
  ASSERT_TRUE(serveUntilBack()) << game->log();
  EXPECT_TRUE(serve([&] { return sees(4, "three") && sees(kDoorRow, "[XX]"); })) << row(*ann, kDoorRow);
  EXPECT_LT(row(*ann, kDoorRow).find("[XX]"), row(*ann, kDoorRow).find("[  ]")) << "that of room one";
  walkToDoor(*ann);
  ASSERT_FALSE(HasFatalFailure()) << game->log();
  press(*ann, df::Keyboard::DOWNARROW);
  EXPECT_TRUE(serve([&] {
    const auto& chat = ann->session().chat();
    return !chat.empty() && chat.back().text.starts_with("There is no room \"one\"");
  }));
}

TEST_F(RoomRecovery, FailedRecoveryAffectsOnlyItsRoom) {
  startJournaled();
  auto ann = join("ann", "one");
  auto bob = join("bob", "two");
  type(*ann, 2);
  type(*bob, 2);
  ASSERT_TRUE(serve([&] { return isWritten("two"); }));
  kill();
  ASSERT_EQ(roundsOf("two").size(), 1u);
  std::ofstream(roundsOf("two").front(), std::ios::binary | std::ios::app)
      << encodeDfrMeta({{kFactAttempts, "3 1000000"}});
  startJournaled();
  ASSERT_TRUE(serveUntilBack()) << game->log();
  ASSERT_TRUE(serve([&] { return shown(*ann).process > 0 && shown(*bob).process > 0; })) << game->log();
  ASSERT_TRUE(serve([&] { return returned() == 1; })) << game->log();
  EXPECT_EQ(shown(*ann).keys, 2);
  EXPECT_EQ(shown(*bob).keys, 0) << "the next round";
  EXPECT_EQ(bob->session().welcome().room, "two");
  EXPECT_TRUE(waitForLog("room two: giving up"));
}

}  // namespace
}  // namespace naiad::test
