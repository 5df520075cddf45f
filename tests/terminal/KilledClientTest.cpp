// The real programs: a dfclient is killed in the middle of the game, and the next one goes on with its ship.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <filesystem>
#include <memory>
#include <regex>

#include "PtyTerminal.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class KilledClientTest : public testing::Test {
 protected:
  KilledClientTest() {
    std::string name = std::filesystem::temp_directory_path() / "naiad-killed-XXXXXX";
    m_home = mkdtemp(name.data());
    PtyTerminal::Options options = inHome();
    options.command = {programPath("dfserver"),
                       "--game",
                       "saucershoot",
                       "--seed",
                       "1",
                       "--address",
                       "127.0.0.1",
                       "--port",
                       "0"};
    options.columns = 300;
    m_server = std::make_unique<PtyTerminal>(options);
  }
  ~KilledClientTest() override {
    m_server.reset();
    std::filesystem::remove_all(m_home);
  }

  PtyTerminal::Options inHome() const {
    PtyTerminal::Options options;
    for (const char* kind : {"CONFIG", "DATA", "STATE"}) {
      options.environment["XDG_" + std::string(kind) + "_HOME"] = m_home / kind;
    }
    return options;
  }
  /// As the server's own line says.
  std::unique_ptr<PtyTerminal> join(const std::vector<std::string>& more = {}) {
    EXPECT_TRUE(m_server->waitFor("From elsewhere")) << m_server->output();
    std::smatch found;
    const std::regex line("dfclient (naiad://\\S+)");
    const std::string said = m_server->output();
    if (!std::regex_search(said, found, line)) throw std::runtime_error("no line to join with: " + said);
    PtyTerminal::Options options = inHome();
    options.command = {programPath("dfclient"), found[1], "--name", "ann"};
    options.command.insert(options.command.end(), more.begin(), more.end());
    auto terminal = std::make_unique<PtyTerminal>(options);
    EXPECT_TRUE(terminal->waitFor("points")) << terminal->output();
    return terminal;
  }
  static void kill(PtyTerminal& terminal) {
    terminal.signal(SIGKILL);
    const int status = terminal.waitForExit();
    EXPECT_TRUE(WIFSIGNALED(status));
  }
  std::string serverSaid() {
    m_server->read(100ms);
    return m_server->output();
  }

  std::filesystem::path m_home;
  std::unique_ptr<PtyTerminal> m_server;
};

constexpr const char* kBack = "You are back in your old session.";

TEST_F(KilledClientTest, GoesOnWithItsShipAndItsPoints) {
  auto terminal = join();
  EXPECT_EQ(terminal->output().find(kBack), std::string::npos);
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
    EXPECT_EQ(terminal->output().find("ann2"), std::string::npos);
    // The first list of players may come after the first picture.
    terminal->resize(15, 5);
    ASSERT_TRUE(terminal->waitFor("too small"));
    terminal->forget();
    terminal->resize(101, 30);
    ASSERT_TRUE(terminal->waitFor("points"));
    const std::string screen = terminal->newOutput();
    std::smatch found;
    if (std::regex_search(screen, found, std::regex("(\\d+) points"))) last = std::stoi(found[1]);
  }
  EXPECT_GT(last, 0) << "a new player would have none";
  terminal->type("\x03");
  EXPECT_EQ(WEXITSTATUS(terminal->waitForExit()), 0);
  const std::string said = serverSaid();
  EXPECT_NE(said.find("\"ann\" is back"), std::string::npos) << said;
  EXPECT_NE(said.find("\"ann\" left"), std::string::npos) << said;
  EXPECT_EQ(said.find("joined"), said.rfind("joined")) << said;

  terminal = join();
  EXPECT_EQ(terminal->output().find(kBack), std::string::npos) << "a player that left does not come back";
}

TEST_F(KilledClientTest, IsForgottenIfThePlayerWantsIt) {
  auto terminal = join();
  kill(*terminal);
  terminal = join({"--no-resume"});
  terminal->read(300ms);
  EXPECT_EQ(terminal->output().find(kBack), std::string::npos);
  kill(*terminal);
  const std::string said = serverSaid();
  EXPECT_NE(said.find("\"ann2\" joined"), std::string::npos) << said;
}

TEST_F(KilledClientTest, AFileThatOthersCanReadIsReported) {
  auto terminal = join();
  kill(*terminal);
  namespace fs = std::filesystem;
  for (const auto& entry : fs::directory_iterator(m_home / "STATE" / "naiad" / "sessions")) {
    fs::permissions(entry.path(), fs::perms::others_read, fs::perm_options::add);
  }
  terminal = join();
  EXPECT_NE(terminal->output().find("is not used: it is not a file of yours alone."), std::string::npos)
      << terminal->output();
  terminal->type("\x03");
  EXPECT_EQ(WEXITSTATUS(terminal->waitForExit()), 0);
}

}  // namespace
}  // namespace naiad::test
