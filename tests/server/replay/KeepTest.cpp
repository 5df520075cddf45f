// dfctl restart --keep with the programs as they are: the round goes on in the program and the game that are
// installed by then, if they play it the same.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/program/RoundHandover.h"
#include "shared/net/base/Limits.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/support/RunProgram.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIsBack = "is back, in the round that goes on";

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

int timesIn(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

class KeepTest : public testing::Test {
 public:
  static constexpr std::chrono::seconds kPatience{60};

 protected:
  void SetUp() override {
    char name[] = "/tmp/naiad-keep-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder = name;
    fs::copy_file(NAIAD_BINARY_DIR "/../lib/games/hello.so", folder / "mine.so");
  }
  void TearDown() override {
    for (const pid_t one : {bots, server}) {
      if (one > 0 && kill(one, SIGKILL) == 0) waitpid(one, nullptr, 0);
    }
    if (!folder.empty()) fs::remove_all(folder);
  }

  pid_t run(std::vector<std::string> words, const char* p_output) const {
    const pid_t process = fork();
    if (process != 0) return process;
    if (chdir(folder.c_str()) != 0) _exit(126);
    [[maybe_unused]] const bool out = freopen(p_output, "a", stdout) != nullptr;
    [[maybe_unused]] const bool err = freopen(p_output, "a", stderr) != nullptr;
    setenv("HOME", folder.c_str(), 1);
    words.front() = NAIAD_BINARY_DIR "/" + words.front();
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(pointers[0], pointers.data());
    _exit(127);
  }
  void start(const std::string& journal) {
    fs::remove(folder / "join");
    std::vector<std::string> words{"dfserver",         "--game=./mine.so",  "--port=" + port(),
                                   "--port-file=port", "--join-file=join",  "--identity=key",
                                   "--state=off",      "--frame-time=5000", "--control=control.sock"};
    if (!journal.empty()) words.push_back("--journal=" + journal);
    server = run(words, "out.txt");
    ASSERT_TRUE(waitUntil([this] { return !contentOf(folder / "join").empty(); })) << log();
  }
  std::string port() const {
    const std::string known = contentOf(folder / "port");
    return known.empty() ? "0" : std::to_string(std::atoi(known.c_str()));
  }
  void startBots() {
    std::vector<std::string> words{"dfbot", "--clients=2", "--random=1", "--seconds=300", "--rejoin"};
    std::istringstream join(contentOf(folder / "join"));
    for (std::string word; join >> word;) words.push_back(word);
    bots = run(words, "bots.txt");
    ASSERT_TRUE(waitUntil([this] { return status("players") == 2; })) << contentOf(folder / "bots.txt");
  }
  std::pair<int, std::string> control(const std::string& command) const {
    return test::runProgram(NAIAD_BINARY_DIR "/dfctl --control " + (folder / "control.sock").string() + " " +
                            command + " 2>&1 </dev/null");
  }
  template <class Done>
  static bool waitUntil(Done done) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // before it is looked at again
    }
    return true;
  }
  long status(const std::string& name) const {
    const std::string answer = test::Talk(folder / "control.sock").ask(R"({"command":"status"})");
    const std::size_t at = answer.find("\"" + name + "\":");
    return at == std::string::npos ? -1 : std::atol(answer.c_str() + at + name.size() + 3);
  }
  bool playTicks(long count) const {
    const long end = status("ticks") + count;
    return waitUntil([&] { return status("ticks") >= end; });
  }
  /// Another version of the game is installed.
  void install(const std::string& bytes) const {
    std::ofstream(folder / "new.so", std::ios::binary) << bytes;
    fs::rename(folder / "new.so", folder / "mine.so");
  }
  std::string log() const { return contentOf(folder / "out.txt"); }
  bool areBack(int times) const {
    return waitUntil([&] { return timesIn(log(), kIsBack) >= times; });
  }
  bool lives() const { return waitpid(server, nullptr, WNOHANG) == 0; }
  /// By which the kernel knows the socket that listens on the port.
  std::string listener() const {
    std::ostringstream place;
    place << ":" << std::hex << std::uppercase << std::atoi(port().c_str()) << " ";
    for (const char* p_table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
      std::istringstream lines(contentOf(p_table));
      for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find(place.str());
        if (at == std::string::npos || line.find(" 0A ") == std::string::npos) continue;
        std::istringstream fields(line);
        std::string field;
        for (int i = 0; i < 10; ++i) fields >> field;
        return field;
      }
    }
    return {};
  }
  fs::path round() const {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "rounds", error)) return entry.path();
    return {};
  }
  void expectOneWholeRound() {
    kill(bots, SIGKILL);
    waitpid(std::exchange(bots, 0), nullptr, 0);
    kill(server, SIGTERM);
    waitpid(std::exchange(server, 0), nullptr, 0);
    fs::directory_iterator files(folder / "rounds");
    EXPECT_EQ(std::distance(begin(files), end(files)), 1) << log();
    const auto [code, said] = test::runProgram(NAIAD_BINARY_DIR "/dfreplay " + round().string() +
                                               " --verify --game " + (folder / "mine.so").string() + " 2>&1");
    EXPECT_EQ(code, 0) << said << log();
  }

  fs::path folder;
  pid_t server = 0;
  pid_t bots = 0;
};

TEST_F(KeepTest, ThePlayersPlayOnInTheSameRound) {
  start("rounds");
  startBots();
  ASSERT_TRUE(playTicks(200));
  const std::string before = listener();
  EXPECT_NE(before, "");
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 0) << said << log();
  EXPECT_NE(said.find("The round goes on in the program that is installed."), std::string::npos) << said;
  EXPECT_TRUE(areBack(2)) << log();
  EXPECT_TRUE(lives()) << "it is the same process";
  EXPECT_EQ(listener(), before) << "players who come meanwhile wait";
  EXPECT_NE(log().find("the round is executed again in this program: "), std::string::npos) << log();
  EXPECT_EQ(log().find("the server was killed"), std::string::npos) << log();
  ASSERT_TRUE(playTicks(100));
  EXPECT_EQ(control("restart --keep").first, 0) << log();
  EXPECT_TRUE(areBack(4)) << "and again: " << log();
  expectOneWholeRound();
}

TEST_F(KeepTest, AGameThatPlaysTheSameGoesOnWithTheRoundAndAlsoAfterAKill) {
  start("rounds");
  startBots();
  ASSERT_TRUE(playTicks(200));
  install(contentOf(folder / "mine.so") + "another build");
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 0) << said << log();
  EXPECT_TRUE(areBack(2)) << log();
  ASSERT_TRUE(playTicks(100));
  kill(server, SIGKILL);
  waitpid(server, nullptr, 0);
  start("rounds");
  EXPECT_TRUE(areBack(4)) << log();
  expectOneWholeRound();
}

TEST_F(KeepTest, AGameThatPlaysOtherwiseIsRefusedAndThePlayersFinish) {
  start("rounds");
  startBots();
  ASSERT_TRUE(playTicks(200));
  install(contentOf(NAIAD_BINARY_DIR "/../lib/games/maze.so"));
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 1) << said;
  EXPECT_NE(said.find("The round cannot go on in the program that is installed: tick "), std::string::npos)
      << said;
  EXPECT_NE(said.find("The server restarts when all have left"), std::string::npos) << said;
  EXPECT_TRUE(playTicks(100)) << "the game goes on";
  EXPECT_EQ(status("players"), 2);
  EXPECT_EQ(control("cancel").first, 0);
  kill(bots, SIGKILL);
  waitpid(std::exchange(bots, 0), nullptr, 0);
  EXPECT_TRUE(playTicks(50)) << log();
}

TEST_F(KeepTest, WithoutAJournalASentenceSaysSo) {
  start("");
  const auto [code, said] = control("restart keep");
  EXPECT_EQ(code, 1) << said;
  EXPECT_NE(said.find("No round can be kept here: that takes dfserver with --journal."), std::string::npos)
      << said;
  EXPECT_TRUE(playTicks(10));
}

TEST(RoundHandoverTest, TheVerdictIsAsDfreplaySaysIt) {
  const std::string good = "note: x\nverified ticks=9 times_real_time=9 protocol=";
  const std::string ours = std::to_string(kProtocolVersion);
  EXPECT_EQ(readVerdict(0, good + ours + " read to its end\n"), "");
  EXPECT_EQ(readVerdict(0, good + "9000 read to its end\n"),
            "it speaks protocol 9000, and the players' clients speak " + ours);
  EXPECT_EQ(readVerdict(0, "verified ticks=9\n"), "it does not say which protocol it speaks");
  EXPECT_EQ(readVerdict(1, "note: x\ntick 51: the state is not as it was recorded\nWhat player 1 saw\n"),
            "tick 51: the state is not as it was recorded");
  EXPECT_EQ(readVerdict(3, "dfreplay: the file is damaged.\n"), "dfreplay: the file is damaged");
  EXPECT_EQ(readVerdict(3, ""), "dfreplay ended with code 3");
  EXPECT_EQ(readVerdict(127, ""), "dfreplay, which tries that out, cannot be started");
}

}  // namespace
}  // namespace naiad
