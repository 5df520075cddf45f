// A game with its own main(), written without a network (lone/game.cpp): started in a terminal, without one,
// headless, and loaded by dfserver. Real processes, terminals and sockets.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "HomeFixture.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRight = "\033[C";
// Only changed cells are written to the screen. So tests wait for the character after WALKED-, which becomes
// $ and then %, and for the part of a chat line that differs from the previous line.
constexpr const char* kCtrlC = "\x03";

class OwnMain : public HomeFixture {
 protected:
  OwnMain() { configure(""); }

  /// Adds these lines to df-config.txt.
  void configure(const std::string& lines) {
    std::ofstream(m_home / "df-config.txt")
        << "logfile:" << (m_home / "game.log").string() << ",\naddress:127.0.0.1,\n"
        << lines;
  }
  PtyTerminal::Options inHome(std::vector<std::string> command) const {
    PtyTerminal::Options options = HomeFixture::inHome(std::move(command));
    options.environment["DRAGONFLY_CONFIG"] = m_home / "df-config.txt";
    options.environment["NAIAD_PORT"] = "0";
    options.environment["NAIAD_JOIN_FILE"] = m_home / "join";
    options.environment["NAIAD_CLIENT"] = programPath("dfclient");
    options.environment["NAIAD_LOG_FILE"] = "";
    options.environment["DF_COMPAT"] = "";
    options.environment["USER"] = "ann";
    options.columns = 120;
    return options;
  }
  std::unique_ptr<PtyTerminal> start(std::map<std::string, std::string> environment = {}) const {
    PtyTerminal::Options options = inHome({programPath("lone_game")});
    for (auto& [name, value] : environment) options.environment[name] = value;
    return std::make_unique<PtyTerminal>(options);
  }
  /// Starts the game and waits until its player is in the game.
  std::unique_ptr<PtyTerminal> startPlaying() const {
    auto game = start();
    EXPECT_TRUE(game->waitFor("WALKED-0")) << game->output();
    return game;
  }
  std::unique_ptr<PtyTerminal> startServer(std::map<std::string, std::string> environment = {}) const {
    environment["NAIAD_LOCAL_CLIENT"] = "false";
    auto server = start(environment);
    EXPECT_TRUE(server->waitFor("Compatible with")) << server->output();
    return server;
  }
  /// Joins in another terminal with the command from the server's join file.
  std::unique_ptr<PtyTerminal> join(const std::string& name) const {
    std::vector<std::string> command{programPath("dfclient"), "--name", name};
    std::istringstream words(read("join"));
    for (std::string word; words >> word;) command.push_back(word);
    auto terminal = std::make_unique<PtyTerminal>(inHome(command));
    EXPECT_TRUE(terminal->waitFor("WALKED-")) << terminal->output();
    return terminal;
  }
  std::string read(const std::string& file) const { return contentOf(m_home / file); }
  static void expectOrderlyEnd(PtyTerminal& game) {
    expectEnd(game, 0, "after the game, walker 1");
    EXPECT_TRUE(sameModes(game.originalModes(), game.currentModes()));
  }
};

TEST_F(OwnMain, InATerminalItIsPlayedThere) {
  auto game = startPlaying();
  EXPECT_TRUE(has(game->output(), "before the game"));
  EXPECT_TRUE(has(game->output(), "Join from this machine with: dfclient naiad://127.0.0.1:"));
  game->forget();
  game->type(kRight);
  // Unchanged cells are not written again.
  ASSERT_TRUE(game->waitFor("$")) << game->output();
  game->type("q");
  expectOrderlyEnd(*game);
  EXPECT_FALSE(has(game->output(), "printed in step")) << "it would spoil the picture";
  const std::string log = read("game.log");
  EXPECT_TRUE(has(log, "printed in step 1"));
  EXPECT_TRUE(has(log, "\"ann\" joined"));
}

// The world outlives the first run.
TEST_F(OwnMain, PlayersLeaveBeforeTheNextRun) {
  auto game = start({{"LONE_TITLE", "1"}, {"LONE_USHER", "1"}});
  ASSERT_TRUE(game->waitFor("TITLE")) << game->output();
  game->type(kRight);
  ASSERT_TRUE(game->waitFor("WALKED-0")) << game->output();
  game->forget();
  game->type(kRight);
  ASSERT_TRUE(game->waitFor("$")) << game->output() << ": the new player's key had no effect";
  game->type("q");
  expectOrderlyEnd(*game);
  EXPECT_TRUE(has(game->output(), "guests +1-1+2, ticks after q: 0\r\n"));
}

TEST_F(OwnMain, LeavingAtTheTitleEndsTheSession) {
  auto game = start({{"LONE_TITLE", "1"}});
  ASSERT_TRUE(game->waitFor("TITLE")) << game->output();
  game->type(kCtrlC);
  expectOrderlyEnd(*game);
  EXPECT_FALSE(has(game->output(), "WALKED-"));
}

TEST_F(OwnMain, EndsCleanlyWithItsPlayer) {
  struct {
    const char* name;
    const char* configuration;
    const char* key;
  } const rows[] = {{"the player leaves", "", kCtrlC},
                    {"the game is over", "", "x"},
                    {"one player has no next round", "on_game_over:restart,\n", "x"},
                    {"its own client knows the password", "password:sesame,\n", "q"}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    configure(row.configuration);
    auto game = startPlaying();
    game->type(row.key);
    expectOrderlyEnd(*game);
  }
}

TEST_F(OwnMain, CrashRestoresTheTerminal) {
  auto game = startPlaying();
  game->forget();
  game->type("c");
  EXPECT_TRUE(diesOf(*game, SIGABRT));
  // The client exits by itself after the game.
  EXPECT_TRUE(game->waitUntil([&] {
    return has(game->newOutput(), "\033[?1049l") && sameModes(game->originalModes(), game->currentModes());
  })) << game->output();
}

TEST_F(OwnMain, ContinuesUntilOtherPlayersHaveLeft) {
  auto game = startPlaying();
  auto bob = join("bob");
  game->type("q");
  ASSERT_TRUE(game->waitFor("1 still playing")) << game->output();
  bob->forget();
  bob->type(kRight);
  ASSERT_TRUE(bob->waitFor("$")) << bob->output();
  bob->type(kCtrlC);
  EXPECT_EQ(WEXITSTATUS(bob->waitForExit()), 0);
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, OneKeyDoesNotEndTheGameForAll) {
  auto game = startServer();
  auto ann = join("ann");
  auto bob = join("bob");
  bob->type("q");
  EXPECT_EQ(WEXITSTATUS(bob->waitForExit()), 4);
  EXPECT_TRUE(has(bob->output(), "The game is over for you."));
  ann->type("q");  // the server has no local player, so it waits for the next player
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 4);
  auto carl = join("carl");
  carl->type("x");  // this key ends the whole game
  EXPECT_EQ(WEXITSTATUS(carl->waitForExit()), 4);
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, OneKeyEndsTheGameForAllIfConfigured) {
  configure("on_game_over:exit,\n");
  auto game = startServer();
  auto ann = join("ann");
  auto bob = join("bob");
  bob->type("q");
  expectOrderlyEnd(*game);
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 4);
}

TEST_F(OwnMain, FirstPlayerPlaysWhileOthersWaitTheirTurn) {
  configure("input_mode:first,\n");
  auto game = startServer();
  auto ann = join("ann");
  auto bob = join("bob");
  ASSERT_TRUE(bob->waitFor("ann plays; you watch")) << bob->output();
  bob->forget();
  bob->type(kRight);
  bob->type("x");
  ann->type(kRight);
  ASSERT_TRUE(bob->waitFor("$")) << bob->output();
  ann->type(kCtrlC);
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 0);
  ASSERT_TRUE(bob->waitFor("now.")) << bob->output();
  bob->forget();
  bob->type(kRight);
  ASSERT_TRUE(bob->waitFor("%")) << bob->output() << "the keys of a spectator had no effect";
  bob->type("x");
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, WithoutATerminalItServesUntilASignal) {
  PtyTerminal shell(inHome(
      {"/bin/sh", "-c", "\"$0\" </dev/null >\"$1\" 2>&1 & pid=$!; trap 'kill -TERM $pid' TERM; wait; wait",
       programPath("lone_game"), m_home / "out"}));
  ASSERT_TRUE(shell.waitUntil([this] { return has(read("join"), "fingerprint"); }));
  auto ann = join("ann");
  shell.signal(SIGTERM);
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 4);
  EXPECT_TRUE(has(ann->output(), "The server is shutting down."));
  EXPECT_NE(shell.waitForExit(), -1);
  EXPECT_TRUE(has(read("out"), "after the game, walker 1")) << read("out");
}

TEST_F(OwnMain, HeadlessItNeedsNoNetwork) {
  configure("headless:true,\n");
  auto game = start({{"NAIAD_TICKS", "2000"}, {"NAIAD_CLIENT", "/nonexistent"}});
  expectOrderlyEnd(*game);
  EXPECT_FALSE(has(game->output(), "Join from"));
  EXPECT_FALSE(fs::exists(m_home / "CONFIG")) << "a server's key was made";
}

TEST_F(OwnMain, WithoutAClientItIsAServer) {
  auto game = start({{"NAIAD_CLIENT", "/nonexistent"}});
  ASSERT_TRUE(game->waitFor("dfclient not found")) << game->output();
  auto ann = join("ann");
  ann->type("x");
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, RunsWithoutTheOperatorsLibrary) {
  const fs::path libraries = fs::path(programPath("lone_game")).parent_path().parent_path() / "lib";
  fs::create_directory(m_home / "lib");
  fs::copy(libraries / "libdragonfly.so.0", m_home / "lib");
  const auto server = startServer({{"LD_LIBRARY_PATH", m_home / "lib"}, {"NAIAD_LOG_FILE", m_home / "log"}});
  const auto ann = join("ann");
  ann->type("\035t/help\r");
  EXPECT_TRUE(ann->waitFor("no commands")) << ann->output();
  const std::string log = read("log");
  const std::string warning = "scores, bans, dfctl, metrics, local network and bus are not available: " +
                              (m_home / "lib/libdragonfly-ops.so.0").string();
  EXPECT_TRUE(has(log, warning));
  EXPECT_EQ(log.find(warning), log.rfind(warning)) << "once";
}

TEST_F(OwnMain, RunsAsAServerIfTheTerminalCannotDraw) {
  auto game = start({{"TERM", "unknown"}});
  ASSERT_TRUE(game->waitFor("the game continues as a server")) << game->output();
  auto ann = join("ann");
  game->signal(SIGINT);
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, CompatibilityIsOnByDefault) {
  constexpr const char* kYes = "published engine: yes";
  constexpr const char* kNo = "published engine: no";
  EXPECT_TRUE(has(startServer()->output(), kYes));
  EXPECT_TRUE(has(startServer({{"DF_COMPAT", "0"}})->output(), kNo));
  configure("compat:false,\n");
  EXPECT_TRUE(has(startServer()->output(), kNo));
  EXPECT_TRUE(has(startServer({{"DF_COMPAT", "1"}})->output(), kYes));
}

TEST_F(OwnMain, InvalidSettingIsReportedWithExitCode2) {
  configure("max_players:many,\n");
  auto game = start();
  EXPECT_EQ(WEXITSTATUS(game->waitForExit()), 2) << game->output();
  EXPECT_TRUE(has(game->output(), "lone_game: " + (m_home / "df-config.txt").string() + ":3: max_players: "))
      << game->output();
}

TEST_F(OwnMain, HangupOfItsTerminalEndsItCleanly) {
  auto game = startServer();
  auto ann = join("ann");
  game->signal(SIGHUP);
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 4);
  EXPECT_TRUE(has(ann->output(), "The server is shutting down."));
  expectOrderlyEnd(*game);
}

TEST_F(OwnMain, WorldReadablePasswordIsReported) {
  configure("password:sesame,\n");
  fs::permissions(m_home / "df-config.txt", fs::perms::owner_all | fs::perms::others_read);
  startServer();
  EXPECT_TRUE(has(read("game.log"), "df-config.txt has the password, but every user can read it."))
      << read("game.log");
}

TEST_F(OwnMain, IsAModuleOfDfserverToo) {
  PtyTerminal server(inHome(
      {programPath("dfserver"), "--game", programPath("../lib/lone_module.so"), "--address", "127.0.0.1"}));
  ASSERT_TRUE(server.waitFor("Only this machine can join")) << server.output();
  EXPECT_FALSE(has(server.output(), "compat is on"));
  auto ann = join("ann");
  ann->type("q");
  EXPECT_EQ(WEXITSTATUS(ann->waitForExit()), 4);
  auto bob = join("bob");
  bob->type("x");
  expectOrderlyEnd(server);
}

}  // namespace
}  // namespace naiad::test
