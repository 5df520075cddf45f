// Games that are programs, with a process for each round or each player (rounds/game.cpp). Players notice
// little when a world ends, crashes or hangs. Real processes and sockets.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "ProgramFixture.h"
#include "host/world/BuildId.h"
#include "tests/server/host/admin/Talk.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

/// Values that the game draws, such as its global variables.
struct RoundShown {
  int mains = 0;
  int steps = -1;
  int process = 0;
};

class Rounds : public ProgramFixture {
 protected:
  void start(std::map<std::string, std::string> environment) {
    launch("rounds_game", std::move(environment));
  }
  bool isPlaying(TestClient& client) const override { return shown(client).steps >= 0; }
  static RoundShown shown(TestClient& client) {
    const std::string row = ProgramFixture::row(client);
    const auto mains = numberAfter(row, "mains=");
    const auto steps = numberAfter(row, "steps=");
    const auto process = numberAfter(row, "process=");
    // The first pictures of a round may lack a part of the text.
    if (!mains || !steps || !process || row.find(';') == std::string::npos) return {};
    return {*mains, *steps, *process};
  }
  /// Returns the changes of the game's theme that the client heard: + started, - stopped.
  static std::string theme(TestClient& client) {
    std::string heard;
    for (const SoundLine& sound : client.session().popSounds()) {
      if (sound.label != "theme") continue;
      heard += sound.action == SoundLine::Action::kPlay ? '+' : '-';
    }
    return heard;
  }
  /// True if the theme stopped and started again: a start replaces a stop that still waits to be sent.
  static bool beganAgain(const std::string& theme) { return theme == "+-+" || theme == "++"; }
  /// Presses a key at which the game writes a line. Returns the line from the server's `watch` command.
  std::string watchedLine(TestClient& client, df::Keyboard::Key key) {
    Talk talk(game->control());
    EXPECT_EQ(talk.ask(R"({"command":"watch"})"), R"({"ok":true,"text":"The log follows."})");
    EXPECT_TRUE(has(talk.ask(R"({"command":"ping"})"), "\"ok\":true"));  // the watch has begun
    press(client, key);
    std::string line;
    const bool comes = serve([&] {
      while (talk.isReadable()) {
        line = talk.readLine().value_or("\"game\" has hung up");
        if (line.find("\"game\"") != std::string::npos) return true;
      }
      return false;
    });
    return comes ? line : "nothing";
  }
  std::string gamesOwnLog() const { return contentOf(game->directory() / "game.log"); }
  /// Succeeds if there are pictures of all ticks from the first to the last.
  static testing::AssertionResult hasNoGap(const TestClient& client) {
    const auto& pictures = client.pictures();
    const std::uint32_t ticks = pictures.rbegin()->first - pictures.begin()->first + 1;
    if (pictures.size() == ticks) return testing::AssertionSuccess();
    return testing::AssertionFailure() << pictures.size() << " of " << ticks;
  }
};

/// Tests in which ann's key ends the round, and ann and bob continue in the next one.
class RoundEnd : public Rounds {
 protected:
  void expectAnotherRound(df::Keyboard::Key key, const std::string& line) {
    start({{"NAIAD_ON_GAME_OVER", "restart"}});
    auto ann = join("ann");
    auto bob = join("bob");
    const ClientSession* p_session = &ann->session();
    const std::uint32_t player = ann->player();
    press(*ann, df::Keyboard::RIGHTARROW);
    ASSERT_TRUE(serve([&] { return shown(*ann).steps == 1 && shown(*bob).steps == 1; })) << game->log();
    const RoundShown before = shown(*ann);
    EXPECT_EQ(before.mains, 1);
    std::string theme_of_ann = theme(*ann);
    std::string theme_of_bob = theme(*bob);

    const auto began = Clock::now();
    press(*ann, key);
    const auto is_next_round = [&](TestClient& client) {
      const RoundShown now = shown(client);
      return now.steps == 0 && now.process != before.process;
    };
    ASSERT_TRUE(serve([&] { return is_next_round(*ann) && is_next_round(*bob); })) << game->log();
    const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began);
    std::printf("next_round_ms=%lld\n", static_cast<long long>(took.count()));
    EXPECT_EQ(shown(*ann).mains, 1) << "a global is what it was";
    EXPECT_EQ(kill(before.process, 0), -1) << "the round before has a process still";

    EXPECT_EQ(&ann->session(), p_session) << "ann had to join again";
    EXPECT_EQ(ann->player(), player);
    EXPECT_EQ(ann->session().counters().resets, 1u);
    EXPECT_EQ(bob->session().counters().resets, 1u);
    EXPECT_EQ(ann->connection().state(), Connection::State::kJoined);
    EXPECT_FALSE(has(game->log(), "reconnected"));
    ASSERT_TRUE(serve([&] { return heard(*ann, line) && heard(*bob, line); })) << game->log();
    EXPECT_TRUE(serve([&] { return beganAgain(theme_of_ann += theme(*ann)); })) << theme_of_ann;
    EXPECT_TRUE(serve([&] { return beganAgain(theme_of_bob += theme(*bob)); })) << theme_of_bob;
    press(*bob, df::Keyboard::RIGHTARROW);
    EXPECT_TRUE(serve([&] { return shown(*ann).steps == 1; })) << "bob's keys arrive";
    EXPECT_TRUE(serve([&] { return lists(*ann, "ann") && lists(*ann, "bob"); }));
  }
};

TEST_F(RoundEnd, GameOverStartsTheNextRound) {
  expectAnotherRound(df::Keyboard::X, "The round is over; the next one begins.");
}

TEST_F(RoundEnd, CrashStartsTheNextRound) {
  expectAnotherRound(df::Keyboard::C, "The game crashed (SIGABRT); the next round begins.");
}

TEST_F(RoundEnd, HangStartsTheNextRound) {
  expectAnotherRound(df::Keyboard::H, "The game did not answer in time; the next round begins.");
}

TEST_F(Rounds, GameThatCrashesAtStartEndsTheServer) {
  GameProgram hopeless("rounds_game", {{"NAIAD_ON_GAME_OVER", "restart"},
                                       {"ROUNDS_CRASH_AT_ONCE", "1"},
                                       {"NAIAD_WORLD_ENVIRONMENT", "ROUNDS_CRASH_AT_ONCE"}});
  const int status = hopeless.wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status << hopeless.log();
  EXPECT_TRUE(has(hopeless.log(), "the game crashed (SIGABRT)"));
}

TEST_F(Rounds, ServerShutdownEndsItsWorld) {
  start({{"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  const int process = shown(*ann).process;
  game->signal(SIGTERM);
  ASSERT_TRUE(serve([&] { return ann->connection().state() == Connection::State::kEnded; }));
  EXPECT_EQ(ann->connection().message(), "The server is shutting down.");
  const int status = game->wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status << game->log();
  EXPECT_GT(numberAfter(game->log(), " sounds=").value_or(0), 0) << "the theme";
  EXPECT_EQ(kill(process, 0), -1);
}

TEST_F(Rounds, PrivateWorldsCrashAlone) {
  start({{"NAIAD_INPUT_MODE", "private"}});
  auto ann = join("ann");
  auto bob = join("bob");
  EXPECT_NE(shown(*ann).process, shown(*bob).process);
  press(*bob, df::Keyboard::RIGHTARROW);
  ASSERT_TRUE(serve([&] { return shown(*bob).steps == 1; }));
  EXPECT_EQ(shown(*ann).steps, 0) << "ann has a world of her own";
  const int process = shown(*bob).process;

  bob->forgetPictures();
  press(*ann, df::Keyboard::C);
  ASSERT_TRUE(serve([&] { return ann->connection().state() == Connection::State::kEnded; })) << game->log();
  EXPECT_EQ(ann->connection().message(), "The game crashed (SIGABRT).");
  // Another thread writes the log.
  const auto isLogged = [&] {
    return numberAfter(game->log(), "the game crashed (SIGABRT) in tick ").value_or(0) > 0;
  };
  EXPECT_TRUE(serve(isLogged)) << game->log();
  const std::uint32_t then = bob->newestTick();
  ASSERT_TRUE(serve([&] { return bob->newestTick() > then + 100; })) << game->log();
  EXPECT_EQ(shown(*bob).process, process);
  EXPECT_EQ(shown(*bob).steps, 1);
  EXPECT_TRUE(hasNoGap(*bob));
  EXPECT_EQ(bob->session().counters().resets, 0u);
  auto carl = join("carl");
  EXPECT_EQ(shown(*carl).steps, 0);
}

TEST_F(Rounds, LeavingPlayerEndsTheirPrivateWorld) {
  start({{"NAIAD_INPUT_MODE", "private"}});
  auto ann = join("ann");
  auto bob = join("bob");
  const int anns = shown(*ann).process;
  const int bobs = shown(*bob).process;
  ann->connection().leave();
  EXPECT_TRUE(serve([&] { return kill(anns, 0) == -1; })) << game->log();
  press(*bob, df::Keyboard::Q);
  ASSERT_TRUE(serve([&] { return bob->connection().state() == Connection::State::kEnded; })) << game->log();
  EXPECT_EQ(bob->connection().message(), "The game is over for you.");
  EXPECT_TRUE(serve([&] { return kill(bobs, 0) == -1; })) << game->log();
  auto carl = join("carl");
  EXPECT_EQ(shown(*carl).steps, 0) << "the server stays";
}

TEST_F(Rounds, PrivateWorldsHaveRounds) {
  start({{"NAIAD_INPUT_MODE", "private"}, {"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  auto bob = join("bob");
  const int anns = shown(*ann).process;
  const int bobs = shown(*bob).process;
  press(*ann, df::Keyboard::X);
  ASSERT_TRUE(serve([&] { return shown(*ann).process != anns && shown(*ann).steps == 0; })) << game->log();
  EXPECT_EQ(ann->session().counters().resets, 1u);
  EXPECT_EQ(shown(*bob).process, bobs);
  EXPECT_EQ(bob->session().counters().resets, 0u);
}

// ---- output of games --------------------------------------------------------------------------------------

TEST_F(Rounds, WatchShowsPrintedGameOutput) {
  start({{"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  EXPECT_EQ(watchedLine(*ann, df::Keyboard::P), R"({"event":"game","text":"game: printed \\x1b[31mred"})");
}

TEST_F(Rounds, WatchShowsGameLogLines) {
  start({});
  auto ann = join("ann");
  EXPECT_EQ(watchedLine(*ann, df::Keyboard::L), R"({"event":"game","text":"game: logged \\x1b[31mred"})");
  game->end(SIGTERM);
  EXPECT_TRUE(has(gamesOwnLog(), "logged")) << "its own file has it as ever";
}

TEST_F(Rounds, RestartAtRoundEndWaitsAndPlayersReconnect) {
  start({{"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  const int process = shown(*ann).process;
  EXPECT_EQ(Talk(game->control()).ask(R"({"command":"restart","arguments":{"when":"at-round-end"}})"),
            R"({"ok":true,"text":"The server restarts when the round is over."})");
  ASSERT_TRUE(serve([&] {
    return heard(*ann, "The server restarts when this round is over. Your client reconnects automatically.");
  }));
  press(*ann, df::Keyboard::RIGHTARROW);
  ASSERT_TRUE(serve([&] { return shown(*ann).steps == 1; })) << "the round goes on";
  EXPECT_EQ(shown(*ann).process, process);
  press(*ann, df::Keyboard::X);
  ASSERT_TRUE(serve([&] { return ann->connection().state() == Connection::State::kReconnecting; }));
  EXPECT_TRUE(serve([&] { return ann->joined() && shown(*ann).steps == 0; })) << game->log();
  EXPECT_NE(shown(*ann).process, process);
}

// ---- an upgrade -------------------------------------------------------------------------------------------

/// The game uses a copy of this build's library. upgrade() replaces the copy by one with another build id,
/// like a package manager does.
class Upgrade : public Rounds {
 protected:
  void start(std::map<std::string, std::string> environment) {
    fs::create_directory(m_libraries);
    const fs::path built = fs::path(NAIAD_BINARY_DIR).parent_path() / "lib" / kLibrary;
    m_code.resize(fs::file_size(built));  // in a sanitizer build it is too long to be read byte by byte
    std::ifstream(built, std::ios::binary).read(m_code.data(), static_cast<std::streamsize>(m_code.size()));
    write(m_code);
    environment["LD_LIBRARY_PATH"] = m_libraries;
    Rounds::start(std::move(environment));
  }
  void upgrade() {
    std::string id;
    for (std::size_t i = 0; i < ownBuildId().size(); i += 2)
      id.push_back(static_cast<char>(std::stoi(ownBuildId().substr(i, 2), nullptr, 16)));
    const std::size_t at = m_code.find(id);
    ASSERT_NE(at, std::string::npos);
    m_code[at] = static_cast<char>(~m_code[at]);
    write(m_code);
  }
  bool comesBack(TestClient& client) {
    return serve([&] { return client.connection().state() == Connection::State::kReconnecting; }) &&
           serve([&] { return client.joined() && shown(client).steps >= 0; });
  }
  /// True if the server has stopped and started again.
  static bool isBack(const std::string& log) {
    const std::size_t stopped = log.find("stopped: ");
    return stopped != std::string::npos && log.find("listens on", stopped) != std::string::npos;
  }

 private:
  static constexpr const char* kLibrary = "libdragonfly.so.0";

  void write(const std::string& code) const {
    std::ofstream(m_libraries / "new", std::ios::binary) << code;
    fs::rename(m_libraries / "new", m_libraries / kLibrary);
  }

  const fs::path m_libraries = home.identity("libraries");
  std::string m_code;
};

TEST_F(Upgrade, NextRoundDetectsTheUpgradeAndRestartsTheServer) {
  start({{"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  const int process = shown(*ann).process;
  upgrade();
  press(*ann, df::Keyboard::RIGHTARROW);
  ASSERT_TRUE(serve([&] { return shown(*ann).steps == 1; })) << "the round goes on";
  press(*ann, df::Keyboard::X);
  ASSERT_TRUE(comesBack(*ann)) << game->log();
  EXPECT_NE(shown(*ann).process, process);
  EXPECT_TRUE(waitForLog("program was upgraded while it runs: a new game process has another build ("))
      << game->log();
  EXPECT_FALSE(has(game->log(), "sent a malformed answer"));
  // Now the server and its worlds use the new build.
  press(*ann, df::Keyboard::X);
  EXPECT_TRUE(serve([&] { return heard(*ann, "The round is over; the next one begins."); })) << game->log();
}

TEST_F(Upgrade, PrivateWorldsContinueUntilTheirPlayersLeave) {
  start({{"NAIAD_INPUT_MODE", "private"}});
  auto ann = join("ann");
  upgrade();
  TestClient bob(context, game->port(), home.player("bob"));
  clients.push_back(&bob);
  EXPECT_TRUE(serve([&] { return bob.connection().isOver(); })) << game->log();
  EXPECT_EQ(bob.connection().message(), "The server was upgraded. It restarts when all players have left.");
  EXPECT_TRUE(waitForLog("; the server restarts when all players have left")) << game->log();
  press(*ann, df::Keyboard::RIGHTARROW);
  EXPECT_TRUE(serve([&] { return shown(*ann).steps == 1; })) << game->log();
  ann->connection().leave();
  EXPECT_TRUE(serve([&] { return isBack(game->log()); })) << game->log();
  auto carl = join("carl");
  EXPECT_EQ(shown(*carl).steps, 0) << "in a world of the new build";
}

}  // namespace
}  // namespace naiad::test
