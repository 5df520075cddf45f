// The author of a game attacks the server that hosts it (hostile/game.cpp), in private worlds. Each attempt
// must fail, and the server and another player's world must continue. Real processes and sockets.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "ProgramFixture.h"
#include "host/auth/PasswordHash.h"
#include "host/world/Sandbox.h"
#include "tests/support/Processes.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

constexpr const char* kPassword = "open-sesame";
constexpr int kMemory = 1024;  ///< memory limit of a world, in MiB

struct Line {
  pid_t process = 0;
  std::string text;
};

/// False if the process has ended, even if its parent has not yet waited for it.
bool isAlive(pid_t process) {
  const char state = stateOf(process);
  return state != 'X' && state != 'Z';
}

/// dfserver with the hostile game. ann and bob each play in a world of their own.
class HostileGame : public ProgramFixture {
 protected:
  HostileGame() : support(findSandboxSupport()) {}

  void start(std::map<std::string, std::string> environment = {},
             const std::vector<std::string>& arguments = {}) {
    environment.insert({{"NAIAD_GAME", NAIAD_BINARY_DIR "/../lib/hostile_module.so"},
                        {"NAIAD_INPUT_MODE", "private"},
                        {"NAIAD_WORLD_MEMORY", std::to_string(kMemory)}});
    ASSERT_NO_FATAL_FAILURE(launch("dfserver", std::move(environment), arguments));
    std::ofstream(game->playFolder() / "front.new") << game->process();
    std::filesystem::rename(game->playFolder() / "front.new", game->playFolder() / "front");
    bob = join("bob");
    ann = join("ann");
  }
  std::unique_ptr<TestClient> join(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.password = kPassword;
    auto client = ProgramFixture::join(setup);
    EXPECT_TRUE(waitForTicks(*client, 3)) << contentOf(game->playFolder() / "report");
    return client;
  }
  std::vector<Line> report() const {
    std::vector<Line> lines;
    std::ifstream file(game->playFolder() / "report");
    Line line;
    while (file >> line.process && std::getline(file >> std::ws, line.text)) lines.push_back(line);
    return lines;
  }
  /// Returns the processes of the worlds that have finished attacking, in the order of their players.
  std::vector<pid_t> worlds() const {
    std::vector<pid_t> found;
    for (const Line& line : report()) {
      if (line.text == "attacked") found.push_back(line.process);
    }
    return found;
  }
  /// Returns the result of an attempt in the last world that made it; empty if none did.
  std::string result(const std::string& attempt) const {
    std::string found;
    for (const Line& line : report()) {
      if (line.text.starts_with(attempt + ": ")) found = line.text.substr(attempt.size() + 2);
    }
    return found;
  }
  void expectRefused(const std::vector<std::string>& attempts) const {
    for (const std::string& attempt : attempts) EXPECT_EQ(result(attempt), "refused") << attempt;
  }
  /// Returns a world and the two processes that it started. One of the two has lost its parent. Both move to
  /// their own sessions if that is allowed.
  std::vector<pid_t> processesOf(pid_t world) const {
    std::vector<pid_t> all{world};
    for (const Line& line : report()) {
      if (line.text == "child of " + std::to_string(world)) all.push_back(line.process);
    }
    EXPECT_EQ(all.size(), 3u);
    return all;
  }
  static bool areAlive(const std::vector<pid_t>& all) { return std::ranges::all_of(all, isAlive); }
  static bool areGone(const std::vector<pid_t>& all) { return std::ranges::none_of(all, isAlive); }
  /// Checks that bob's world continues to tick and that the server lives.
  void expectTheOthersPlay() {
    EXPECT_TRUE(waitForTicks(*bob, 50)) << game->log();
    EXPECT_TRUE(isAlive(game->process()));
    EXPECT_EQ(bob->session().counters().resets, 0u);
  }

  const SandboxSupport support;
  std::unique_ptr<TestClient> bob;
  std::unique_ptr<TestClient> ann;
};

TEST_F(HostileGame, OpensNoFilesButItsOwn) {
  if (support.landlock == 0) GTEST_SKIP() << "this kernel has no Landlock";
  start();
  const std::string key = contentOf(game->directory() / "identity/key.pem");
  EXPECT_TRUE(has(key, "PRIVATE KEY"));
  expectRefused({"read the key", "empty the key", "list the server's folder", "make a file elsewhere",
                 "make a folder elsewhere", "make a link", "link the key"});
  if (support.landlock >= 3) expectRefused({"empty the log"});
  if (!kSanitized) {
    expectRefused(
        {"read the front's memory", "read the front's environment", "read the front's command line"});
  }
  expectRefused({"read /etc/passwd"});
  for (const char* allowed : {"write into its own folder", "read what it wrote", "read a library"}) {
    EXPECT_EQ(result(allowed), "done") << allowed;
  }
  expectTheOthersPlay();
}

TEST_F(HostileGame, AddsLinesToTheLogAndChangesNone) {
  start();
  if (support.landlock > 0) expectRefused({"write into the log", "write into the output"});
  for (const char* attempt : {"empty the output", "overwrite the output"}) {
    EXPECT_EQ(result(attempt).substr(0, 5), "error") << "it is a pipe";
  }
  EXPECT_EQ(result("print"), "done");
  EXPECT_TRUE(waitForLog(R"( game: 192.0.2.9:1 "nobody" joined\x1b[2J)")) << game->log();
  EXPECT_TRUE(has(game->log(), " game: seed ")) << "what the engine logs there";
  EXPECT_FALSE(has(game->log(), "\x1b"));
  // The flags of the server's own output are unchanged, so the world does not share the server's open file.
  const std::string info = contentOf("/proc/" + std::to_string(game->process()) + "/fdinfo/2");
  if (!info.empty()) {  // only root may read this
    const std::size_t at = info.find("flags:");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NE(std::stoul(info.substr(at + 6), nullptr, 8) & O_APPEND, 0u);
  }
  expectTheOthersPlay();
}

TEST_F(HostileGame, ReachesNoSocketAndNoOtherProcess) {
  if (support.filter == 0) GTEST_SKIP() << "this kernel has no seccomp";
  start();
  expectRefused({"make readable the key", "socket", "local socket", "datagram sockets", "trace the front",
                 "read memory", "write memory", "limit the front", "slow down the front", "move the front",
                 "outlive its supervisor", "hide in /proc", "leave its process group", "kill the front",
                 "kill its supervisor"});
  expectRefused({"bpf", "mount", "keyctl", "perf_event_open", "unshare", "userfaultfd", "io_uring_setup",
                 "a call of tomorrow"});
  expectRefused({"change the server's mode", "change the server's owner", "mark the server",
                 "unmark the server", "flag the server", "seal the server", "lease the server"});
  for (const char* needed : {"thread", "child", "getrandom", "personality", "program"}) {
    EXPECT_EQ(result(needed), "done") << needed;
  }
  expectTheOthersPlay();
}

TEST_F(HostileGame, GetsNoMoreMemoryAndDescriptorsThanItsShare) {
  start();
  const auto number = [this](const char* what) {
    const std::string text = result(what);
    return text.empty() ? -1 : std::stoi(text);
  };
  EXPECT_GT(number("descriptors"), 10);
  EXPECT_LE(number("descriptors"), 1024);
  if (!kSanitized) {
    EXPECT_GE(number("megabytes"), kMemory / 4);
    EXPECT_LE(number("megabytes"), kMemory);
  }
  EXPECT_EQ(number("core"), 0);
  expectTheOthersPlay();
}

TEST_F(HostileGame, IsLoadedOnlyByWorldProcesses) {
  start();
  const std::vector<Line> lines = report();
  EXPECT_FALSE(lines.empty());
  for (const Line& line : lines) EXPECT_NE(line.process, game->process()) << line.text;
  EXPECT_FALSE(has(contentOf("/proc/" + std::to_string(game->process()) + "/maps"), "hostile_module"));
}

TEST_F(HostileGame, LearnsNoPassword) {
  // A password check with 64 MiB is too slow under the thread sanitizer, so its server gets a cheap hash.
  const std::string secret =
      kSanitized ? PasswordHash::of(kPassword, {.memory_kib = 64, .passes = 1}).text() : kPassword;
  start({{"NAIAD_PASSWORD", "not this one"}, {"SECRET_OF_MINE", kPassword}},
        {"--password", secret, "--world-environment", "NAIAD_PASSWORD,HOME"});
  ASSERT_EQ(worlds().size(), 2u);
  const std::filesystem::path world = "/proc/" + std::to_string(worlds().back());
  const std::filesystem::path front = "/proc/" + std::to_string(game->process());
  EXPECT_TRUE(has(contentOf(world / "cmdline"), "hostile_module"));
  EXPECT_TRUE(has(contentOf(world / "environ"), "NAIAD_WORLD_SOCKET"));
  for (const auto& path : {world / "cmdline", world / "environ", front / "cmdline"}) {
    for (const std::string& text : {secret, std::string(kPassword)})
      EXPECT_FALSE(has(contentOf(path), text)) << path;
    EXPECT_FALSE(has(contentOf(path), "not this one")) << path;
  }
}

TEST_F(HostileGame, ItsChildrenEndWithIt) {
  start();
  ASSERT_EQ(worlds().size(), 2u);
  const std::vector<pid_t> of_bob = processesOf(worlds()[0]);
  const std::vector<pid_t> of_ann = processesOf(worlds()[1]);
  EXPECT_TRUE(areAlive(of_ann));
  ann->connection().leave();
  EXPECT_TRUE(serve([&] { return areGone(of_ann); })) << game->log();
  EXPECT_TRUE(areAlive(of_bob));
  expectTheOthersPlay();

  game->end(SIGKILL);
  EXPECT_TRUE(serve([&] { return areGone(of_bob); })) << "the server could not end them any more";
}

TEST_F(HostileGame, ChildrenEndWithTheirSupervisor) {
  start();
  ASSERT_EQ(worlds().size(), 2u);
  const std::vector<pid_t> of_ann = processesOf(worlds()[1]);
  const pid_t supervisor = factsOf(of_ann[0])->parent;
  ASSERT_GT(supervisor, 1);
  kill(supervisor, SIGKILL);
  EXPECT_TRUE(serve([&] { return areGone(of_ann); }));
  EXPECT_TRUE(serve([&] { return ann->connection().state() == Connection::State::kEnded; })) << game->log();
  EXPECT_EQ(ann->connection().message(), "The game crashed (SIGKILL).");
  expectTheOthersPlay();
}

}  // namespace
}  // namespace naiad::test
