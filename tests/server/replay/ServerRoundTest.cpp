// The programs as they are: dfserver writes a round of bots down, dfreplay verifies it; and a server that is
// killed loses none of it.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "host/journal/DfrReader.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

const std::string kBin = std::string(NAIAD_BINARY_DIR) + "/";

pid_t start(const std::vector<std::string>& words, const fs::path& folder) {
  const pid_t process = fork();
  if (process != 0) return process;
  if (chdir(folder.c_str()) != 0) _exit(126);
  [[maybe_unused]] const bool out = freopen("out.txt", "a", stdout) != nullptr;
  [[maybe_unused]] const bool err = freopen("out.txt", "a", stderr) != nullptr;
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  _exit(127);
}

int waitFor(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string textOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ServerRoundTest : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/naiad-server-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }

  pid_t startServer(const std::string& more) {
    fs::remove(folder / "port");
    const pid_t server = start({kBin + "dfserver", "--game=saucershoot", "--insecure", "--port=0",
                                "--port-file=port", "--journal=rounds", more},
                               folder);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (textOf(folder / "port").empty() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return server;
  }
  pid_t startBots() const {
    const int port = std::atoi(textOf(folder / "port").c_str());
    return start({kBin + "dfbot", "127.0.0.1:" + std::to_string(port), "--insecure", "--clients=2",
                  "--random=1", "--seconds=4"},
                 folder);
  }
  fs::path round() const {
    for (const auto& entry : fs::directory_iterator(folder / "rounds")) return entry.path();
    return {};
  }
  std::uint32_t turnsInFile() const {
    const std::string bytes = textOf(round());
    DfrReader reader(bytes);
    std::uint32_t turns = 0;
    while (const auto record = reader.next()) turns += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
    return turns;
  }
  int verify() const { return waitFor(start({kBin + "dfreplay", round().string(), "--verify"}, folder)); }

  fs::path folder;
};

TEST_F(ServerRoundTest, OfTwoBotsIsTheSameAgain) {
  const pid_t server = startServer("--exit-when-empty=1");
  EXPECT_EQ(waitFor(startBots()), 0) << textOf(folder / "out.txt");
  EXPECT_EQ(waitFor(server), 0) << textOf(folder / "out.txt");
  EXPECT_EQ(verify(), 0) << textOf(folder / "out.txt");
  const std::string out = textOf(folder / "out.txt");
  EXPECT_NE(out.find("verified ticks="), std::string::npos) << out;
  EXPECT_EQ(out.find("not repeatable"), std::string::npos) << out;
  for (const char* p_secret : {"127.0.0.1", "/tmp/"})
    EXPECT_EQ(textOf(round()).find(p_secret), std::string::npos) << p_secret;
}

TEST_F(ServerRoundTest, OfAServerThatWasKilledHasTheTurnsThatWaitedForTheDisk) {
  const pid_t server = startServer("--grace=5");
  const pid_t bots = startBots();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while ((!fs::exists(folder / "rounds") || round().empty() || turnsInFile() < 30) &&
         std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(server, SIGKILL);
  EXPECT_EQ(waitFor(server), 128 + SIGKILL);
  kill(bots, SIGKILL);
  waitFor(bots);
  const std::uint32_t before = turnsInFile();
  const fs::path killed = round();
  EXPECT_EQ(waitFor(startServer("--ticks=1")), 0);
  EXPECT_NE(textOf(folder / "out.txt").find("which has all of its turns now"), std::string::npos);
  const std::string bytes = textOf(killed);
  DfrReader reader(bytes);
  std::uint32_t after = 0;
  while (const auto record = reader.next()) after += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
  EXPECT_GE(after, before);
  EXPECT_EQ(waitFor(start({kBin + "dfreplay", killed.string(), "--verify"}, folder)), 0)
      << textOf(folder / "out.txt");
}

}  // namespace
}  // namespace naiad
