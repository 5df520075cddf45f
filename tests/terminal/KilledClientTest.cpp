// The real programs: a dfclient is killed in the middle of the game, and the next one resumes its session.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <memory>

#include "HomeFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class KilledClientTest : public HomeFixture {
 protected:
  KilledClientTest() { serve("hello"); }

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

TEST_F(KilledClientTest, NextClientResumesItsSession) {
  auto terminal = join();
  EXPECT_FALSE(has(terminal->output(), kBack));
  kill(*terminal);
  terminal = join();
  ASSERT_TRUE(terminal->waitFor(kBack)) << terminal->output();
  EXPECT_FALSE(has(terminal->output(), "ann2"));
  terminal->type("\x03");
  EXPECT_TRUE(exits(*terminal, 0));
  const std::string said = serverSaid();
  EXPECT_TRUE(has(said, "\"ann\" reconnected"));
  EXPECT_TRUE(has(said, "\"ann\" left"));
  EXPECT_EQ(countIn(said, "joined"), 1) << said;

  terminal = join();
  EXPECT_FALSE(has(terminal->output(), kBack)) << "a player that left does not come back";
  kill(*terminal);
  namespace fs = std::filesystem;
  for (const auto& entry : fs::directory_iterator(m_home / "STATE" / "naiad" / "sessions"))
    fs::permissions(entry.path(), fs::perms::others_read, fs::perm_options::add);
  terminal = join();
  EXPECT_TRUE(has(terminal->output(), "is ignored: expected a regular file of yours with mode 0600."));
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

}  // namespace
}  // namespace naiad::test
