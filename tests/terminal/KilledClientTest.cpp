// The real programs: a dfclient is killed in the middle of the game, and the next one resumes with its ship.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <memory>
#include <regex>

#include "HomeFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class KilledClientTest : public HomeFixture {
 protected:
  KilledClientTest() { serve("saucershoot", {"--seed", "1"}); }

  std::unique_ptr<PtyTerminal> join(const std::vector<std::string>& more = {}) {
    PtyTerminal::Options options = inHome({programPath("dfclient"), m_link, "--name", "ann"}, more);
    options.columns = 100;
    auto terminal = std::make_unique<PtyTerminal>(options);
    EXPECT_TRUE(terminal->waitFor(" player")) << terminal->output();
    return terminal;
  }
  static void kill(PtyTerminal& terminal) {
    terminal.signal(SIGKILL);
    EXPECT_TRUE(diesOf(terminal, SIGKILL));
  }
  std::string serverSaid() {
    m_server->read(100ms);
    return m_server->output();
  }
};

constexpr const char* kBack = "Session resumed.";

TEST_F(KilledClientTest, ResumesItsSessionAndPoints) {
  auto terminal = join();
  EXPECT_FALSE(has(terminal->output(), kBack));
  int last = 0;
  for (int round = 0; round < 20 && last == 0; ++round) {
    for (int i = 0; i < 20; ++i) {
      terminal->type(" ");
      terminal->read(100ms);
    }
    kill(*terminal);
    terminal = join();
    ASSERT_TRUE(terminal->waitFor(kBack)) << terminal->output();
    terminal->read(700ms);
    EXPECT_FALSE(has(terminal->output(), "ann2"));
    // The first list of players may come after the first picture.
    terminal->resize(15, 5);
    ASSERT_TRUE(terminal->waitFor("too small"));
    terminal->forget();
    terminal->resize(101, 30);
    ASSERT_TRUE(terminal->waitFor(" player"));
    const std::string screen = terminal->newOutput();
    std::smatch found;
    if (std::regex_search(screen, found, std::regex("(\\d+) points?"))) last = std::stoi(found[1]);
  }
  EXPECT_GT(last, 0) << "a new player would have none";
  terminal->type("\x03");
  EXPECT_EQ(WEXITSTATUS(terminal->waitForExit()), 0);
  const std::string said = serverSaid();
  EXPECT_TRUE(has(said, "\"ann\" reconnected"));
  EXPECT_TRUE(has(said, "\"ann\" left"));
  EXPECT_EQ(said.find("joined"), said.rfind("joined")) << said;

  terminal = join();
  EXPECT_FALSE(has(terminal->output(), kBack)) << "a player that left does not come back";
}

TEST_F(KilledClientTest, NoResumeOptionJoinsAsANewPlayer) {
  auto terminal = join();
  kill(*terminal);
  terminal = join({"--no-resume"});
  terminal->read(300ms);
  EXPECT_FALSE(has(terminal->output(), kBack));
  kill(*terminal);
  const std::string said = serverSaid();
  EXPECT_TRUE(has(said, "\"ann2\" joined"));
}

TEST_F(KilledClientTest, AFileThatOthersCanReadIsReported) {
  auto terminal = join();
  kill(*terminal);
  namespace fs = std::filesystem;
  for (const auto& entry : fs::directory_iterator(m_home / "STATE" / "naiad" / "sessions")) {
    fs::permissions(entry.path(), fs::perms::others_read, fs::perm_options::add);
  }
  terminal = join();
  EXPECT_TRUE(has(terminal->output(), "is ignored: expected a regular file of yours with mode 0600."));
  terminal->type("\x03");
  EXPECT_EQ(WEXITSTATUS(terminal->waitForExit()), 0);
}

}  // namespace
}  // namespace naiad::test
