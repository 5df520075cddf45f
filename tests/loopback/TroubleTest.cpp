// A server whose log reader stalls or exits, or whose game crashes or hangs (trouble/game.cpp).
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "ProgramFixture.h"
#include "engine/events/EventStep.h"
#include "engine/world/Object.h"
#include "engine/world/WorldLog.h"
#include "host/auth/PasswordHash.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGoodbye = "The server is shutting down.";

/// A pipe that holds 4096 bytes.
struct Pipe {
  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    fcntl(ends[1], F_SETPIPE_SZ, 4096);
  }
  ~Pipe() {
    closeReader();
    close(ends[1]);
  }
  void closeReader() {
    if (ends[0] >= 0) close(ends[0]);
    ends[0] = -1;
  }
  /// Fills the pipe, whatever it contains, so that writing blocks until the pipe is read.
  void fill() const {
    const int end = open(("/proc/self/fd/" + std::to_string(ends[1])).c_str(),
                         O_WRONLY | O_NONBLOCK | O_CLOEXEC);  // the program's descriptor must block
    ASSERT_GE(end, 0);
    while (write(end, "#", 1) == 1) {
    }
    EXPECT_EQ(errno, EAGAIN);
    close(end);
  }
  int ends[2];
};

class Trouble : public ProgramFixture {
 protected:
  void TearDown() override {
    if (game) game->signal(SIGKILL);  // ends a game that may hang; the tests check nothing after this
  }
  void start(std::map<std::string, std::string> environment = {}, int errors = -1) {
    launch("trouble_game", std::move(environment), {}, errors);
  }
  bool isDismissed(TestClient& client) { return ProgramFixture::isDismissed(client, kGoodbye); }
};

// ---- the log ----------------------------------------------------------------------------------------------

TEST_F(Trouble, StalledOrClosedLogPipeStopsNoGame) {
  Pipe pipe;
  start({{"NAIAD_LOG_FILE", ""}}, pipe.ends[1]);
  auto ann = join("ann");
  pipe.fill();
  auto bob = join("bob");
  EXPECT_TRUE(waitForTicks(*ann, 300) && waitForTicks(*bob));
  pipe.closeReader();
  EXPECT_TRUE(waitForTicks(*ann) && waitForTicks(*bob));
  press(*ann, df::Keyboard::P);
  EXPECT_TRUE(waitForTicks(*ann) && waitForTicks(*bob));
  bob->connection().leave();
  EXPECT_TRUE(waitForTicks(*ann));
  game->signal(SIGTERM);
  EXPECT_TRUE(isDismissed(*ann));
  const int status = game->wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(Trouble, ShutdownLogCountsRefusedPasswords) {
  start({{"NAIAD_PASSWORD", PasswordHash::of("xyzzy", {.memory_kib = 64, .passes = 1}).text()}});
  for (const std::string password : {"plugh", "", "xyzzy"}) {
    ClientSetup setup = home.player("ann");
    setup.options.password = password;
    TestClient ann(context, game->port(), setup);
    clients = {&ann};
    EXPECT_TRUE(serve([&] { return ann.joined() || ann.connection().isOver(); }));
    clients.clear();
  }
  game->end(SIGTERM);
  EXPECT_TRUE(has(game->log(), " refused_password=2 "));
  EXPECT_TRUE(has(game->log(), "passwords: right=1 wrong=1 malformed=1\n"));
}

// ---- signals ----------------------------------------------------------------------------------------------

TEST_F(Trouble, SighupWithoutATerminalOpensTheLogAgain) {
  start();
  auto ann = join("ann");
  ASSERT_TRUE(waitForLog("\"ann\" joined"));
  fs::rename(game->directory() / "log", game->directory() / "log.1");
  game->signal(SIGHUP);
  EXPECT_TRUE(waitForLog("SIGHUP: log reopened")) << game->log();
  EXPECT_FALSE(has(game->log(), "\"ann\" joined")) << "this is the old file";
  EXPECT_TRUE(waitForTicks(*ann));
}

// ---- a game that hangs ------------------------------------------------------------------------------------

TEST_F(Trouble, HungGameIsReportedAndFirstSignalEndsIt) {
  if (kThreadSanitized) GTEST_SKIP() << "this sanitizer keeps signals from a thread that only computes";
  start();
  auto ann = join("ann");
  press(*ann, df::Keyboard::H);
  ASSERT_TRUE(waitForLog("the game has not finished tick ")) << game->log();
  EXPECT_TRUE(waitForLog(" for 1 s: it hangs, and all players wait, while Trouble handles EventKeyboard\n"))
      << game->log();
  game->signal(SIGTERM);
  EXPECT_TRUE(isDismissed(*ann)) << ann->connection().message();
  const int status = game->wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status << game->log();
  EXPECT_TRUE(waitForLog("forced to exit: the game does not finish tick ")) << game->log();
}

TEST_F(Trouble, SecondSignalEndsHungGameAtOnceWithGoodbye) {
  if (kThreadSanitized) GTEST_SKIP() << "this sanitizer keeps signals from a thread that only computes";
  start();
  auto ann = join("ann");
  ASSERT_TRUE(waitForTicks(*ann, 1));
  press(*ann, df::Keyboard::H);
  const auto stands = [&, last = ann->newestTick(), since = Clock::now()]() mutable {
    if (ann->newestTick() != last) since = Clock::now();
    last = ann->newestTick();
    return Clock::now() - since > std::chrono::milliseconds(500);  // 100 ticks without a new one
  };
  ASSERT_TRUE(serve(stands));
  game->signal(SIGTERM);
  const auto repeats = [&] {  // because signals that arrive together count as one
    game->signal(SIGINT);
    return ann->connection().isOver();
  };
  EXPECT_TRUE(serve(repeats));
  EXPECT_TRUE(isDismissed(*ann)) << ann->connection().message();
  const int status = game->wait();
  EXPECT_TRUE(WIFSIGNALED(status)) << status << game->log();
}

TEST_F(Trouble, SlowTickIsReportedOnceWithItsHandler) {
  for (const std::string on_game_over :
       {"leave", "restart"}) {  // restart: the world has a process of its own
    start({{"NAIAD_ON_GAME_OVER", on_game_over}});
    auto ann = join("ann");
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(waitForTicks(*ann, 1));
      press(*ann, df::Keyboard::S);
      ASSERT_TRUE(waitForTicks(*ann));
    }
    const auto text = [&] { return game->log() + contentOf(game->directory() / "output"); };
    const std::string line = " takes longer than the frame time of ";
    const std::string rest =
        " ms, while Trouble handles EventKeyboard: the game is not smooth (reported once)\n";
    EXPECT_TRUE(serve([&] { return has(text(), line); })) << text();
    EXPECT_TRUE(has(text(), rest)) << text();
    clients.clear();
  }
}

// ---- a game that crashes ----------------------------------------------------------------------------------

struct CrashCase {
  const char* name;
  df::Keyboard::Key key;
  int signal;
  const char* signal_name = "SIGSEGV";
  const char* activity = "Trouble handled EventKeyboard";
};

class Crash : public Trouble, public testing::WithParamInterface<CrashCase> {};

TEST_P(Crash, IsLoggedWithItsHandler) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer reports crashes itself";
  const CrashCase& crash = GetParam();
  start();
  auto ann = join("ann");
  ASSERT_TRUE(waitForTicks(*ann, 1));
  press(*ann, crash.key);
  waitForLog("crashed");
  const int status = game->wait();
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == crash.signal) << status << game->log();
  for (const char* file : {"log", "output"}) {
    const std::string text = contentOf(game->directory() / file);
    const std::string line = std::string(" trouble_game: crashed (") + crash.signal_name + ") in tick ";
    ASSERT_TRUE(has(text, line)) << file << ": ";
    EXPECT_GT(std::atoi(text.c_str() + text.find(line) + line.size()), 0) << text;
    EXPECT_TRUE(has(text, std::string(", while ") + crash.activity + "\n"));
    EXPECT_TRUE(has(text, "trouble_game: the game's log: a key\\x1b[2J\n"));
    EXPECT_TRUE(has(text, "trouble_game: to see where: gdb "));
  }
}

INSTANTIATE_TEST_SUITE_P(Games, Crash,
                         testing::Values(CrashCase{"EndlessRecursion", df::Keyboard::R, SIGSEGV},
                                         CrashCase{"Abort", df::Keyboard::A, SIGABRT, "SIGABRT"},
                                         CrashCase{"InDraw", df::Keyboard::D, SIGSEGV, "SIGSEGV",
                                                   "Trouble ran draw()"},
                                         CrashCase{"DivisionByZero", df::Keyboard::Z, SIGFPE, "SIGFPE"},
                                         CrashCase{"AfterANestedHandler", df::Keyboard::N, SIGSEGV}),
                         [](const auto& one) { return std::string(one.param.name); });

/// Like the tests above, but the world is in its own process, which shares its crash page with the front
/// process.
TEST_F(Trouble, WorldProcessCrashAndHangAreLogged) {
  start({{"NAIAD_ON_GAME_OVER", "restart"}});
  auto ann = join("ann");
  ASSERT_TRUE(waitForTicks(*ann, 1));
  press(*ann, df::Keyboard::K);
  EXPECT_TRUE(waitForLog("the round is over: the game crashed (SIGKILL) in tick ")) << game->log();
  EXPECT_TRUE(waitForLog(", while Trouble handled EventKeyboard\n")) << game->log();
  EXPECT_TRUE(waitForLog(" the game's log: a key\\x1b[2J\n")) << game->log();
  EXPECT_TRUE(waitForLog(" to see where: run the game by itself in a debugger")) << game->log();
  EXPECT_TRUE(waitForTicks(*ann)) << "the next round";
  press(*ann, df::Keyboard::H);
  EXPECT_TRUE(waitForLog(" for 1 s: it hangs, and all players wait, while Trouble handles EventKeyboard\n"))
      << game->log();
  EXPECT_TRUE(serve([&] {
    const auto& chat = ann->session().chat();
    return std::ranges::any_of(chat, [](const ChatEntry& entry) {
      return entry.name.empty() && entry.text.find("The game is not responding") != std::string::npos;
    });
  })) << "its player knows";
  EXPECT_TRUE(waitForLog("the game did not answer in time in tick ")) << game->log();
}

// ---- programs that never play -----------------------------------------------------------------------------

/// Runs a program with this mistake (makeMistake()). Returns its log, and in `code` its exit code.
std::string lastWords(const std::string& mistake, int& code) {
  GameProgram game("trouble_game", {{"TROUBLE", mistake}});
  const int status = game.wait();
  code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return game.log();
}

TEST(ProgramMistakes, AreExplainedInTheLog) {
  int code = 0;
  EXPECT_TRUE(has(lastWords("no-run", code),
                  "trouble_game: the program ended without GM.run(), so nothing was played\n"));
  const std::string no_start = lastWords("no-start", code);
  EXPECT_TRUE(
      has(no_start, "trouble_game: GM.run() was called before GM.startUp(), which reads the settings\n"));
  EXPECT_EQ(code, 1);
  const std::string exits = lastWords("exit", code);
  EXPECT_TRUE(has(exits,
                  "trouble_game: exit() was called in tick 1, while Exits handled EventStep; use "
                  "GM.setGameOver() to end a game\n"));
  if (kSanitized) return;  // the sanitizer reports crashes itself
  const std::string before = lastWords("crash-before-run", code);
  EXPECT_TRUE(has(before, "trouble_game: crashed (SIGSEGV) before the first tick\n"));
  EXPECT_TRUE(
      has(before, "trouble_game: the game's log: Sprite ship: no/such.txt: cannot be read; looked in "));
}

/// A log that a game can block, because it writes under a lock like the engine's own log.
struct HeldLog {
  void operator()(const std::string& line) {
    if (line.find("the game has not finished tick") != std::string::npos) reported = true;
    const std::lock_guard lock(mutex);
  }
  std::mutex mutex;
  std::atomic<bool> reported = false;
};

/// Hangs while it holds the log's lock. Raises two signals after the report of the hang.
class HangsWhileItLogs : public df::Object {
 public:
  explicit HangsWhileItLogs(HeldLog& log) : m_log(log) { registerInterest(df::STEP_EVENT); }
  int eventHandler(const df::Event* /*p_e*/) override {
    const std::lock_guard lock(m_log.mutex);
    while (!m_log.reported) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    raise(SIGINT);
    raise(SIGTERM);
    for (;;) pause();
  }

 private:
  HeldLog& m_log;
};

TEST(TroubleDeathTest, SignalsEndAHungGameThatLocksTheLog) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto hang = [] {
    alarm(30);  // ends a test that hangs
    HeldLog log;
    Host host(fastOptions(), "test", [&log](const std::string& line) { log(line); });
    df::World world;
    world.log().setSink([](const std::string&) {});
    const df::World::Scope scope(world);
    new HangsWhileItLogs(log);
    host.run(world);
  };
  EXPECT_EXIT(hang(), testing::ExitedWithCode(1), "");  // 1 is the exit code for a game that hangs
}

}  // namespace
}  // namespace naiad::test
