// The real dfbot: it says ok only if the server was there to the end, and if it has compared what it should.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "PtyTerminal.h"

namespace naiad::test {
namespace {

class BotExitTest : public testing::Test {
 protected:
  BotExitTest() {
    std::string name = std::filesystem::temp_directory_path() / "naiad-bot-XXXXXX";
    m_home = mkdtemp(name.data());
    PtyTerminal::Options options;
    options.command = {programPath("dfserver"),
                       "--game",
                       "hello",
                       "--insecure",
                       "--address",
                       "127.0.0.1",
                       "--port",
                       "0",
                       "--seed",
                       "1",
                       "--port-file",
                       file("port"),
                       "--truth",
                       file("truth")};
    m_server = std::make_unique<PtyTerminal>(options);
  }
  ~BotExitTest() override {
    m_server.reset();
    std::filesystem::remove_all(m_home);
  }

  std::string file(const char* name) const { return m_home / name; }
  /// Start a bot, and wait until the server has it.
  std::unique_ptr<PtyTerminal> join(const std::vector<std::string>& more) {
    std::string port;
    EXPECT_TRUE(m_server->waitUntil([&] { return static_cast<bool>(std::ifstream(file("port")) >> port); }));
    PtyTerminal::Options options;
    options.command = {programPath("dfbot"), "127.0.0.1:" + port, "--insecure", "--quiet"};
    options.command.insert(options.command.end(), more.begin(), more.end());
    options.columns = 300;
    auto bot = std::make_unique<PtyTerminal>(options);
    EXPECT_TRUE(m_server->waitFor("\"bot\" joined")) << m_server->output();
    return bot;
  }
  /// The server has sent the bot pictures.
  void waitForPictures() {
    EXPECT_TRUE(m_server->waitUntil([&] {
      std::ifstream in(file("truth"));
      int ticks = 0;
      for (std::string line; std::getline(in, line);) ticks += line.rfind("tick ", 0) == 0 ? 1 : 0;
      return ticks >= 10;
    }));
  }
  static void expectEnd(PtyTerminal& bot, int code, const std::string& sentence) {
    const int status = bot.waitForExit();
    EXPECT_TRUE(WIFEXITED(status)) << bot.output();
    EXPECT_EQ(WEXITSTATUS(status), code) << bot.output();
    EXPECT_NE(bot.output().find(sentence), std::string::npos) << bot.output();
    EXPECT_EQ(bot.output().find("bot ok") != std::string::npos, code == 0) << bot.output();
  }

  std::filesystem::path m_home;
  std::unique_ptr<PtyTerminal> m_server;
};

TEST_F(BotExitTest, AFolderIsNoScript) {
  PtyTerminal::Options options;
  options.command = {programPath("dfbot"), "127.0.0.1:1", "--insecure", "--script", m_home.string()};
  options.columns = 300;
  PtyTerminal bot(options);
  expectEnd(bot, 2, "dfbot: --script: " + m_home.string() + " is a folder");
}

TEST_F(BotExitTest, IsOkIfWhatItSawIsTheTruth) {
  expectEnd(*join({"--seconds", "1", "--truth", file("truth")}), 0, "wrong_cells=0");
}

TEST_F(BotExitTest, NothingComparedIsNotOk) {
  std::ofstream(file("empty"));
  expectEnd(*join({"--seconds", "1", "--truth", file("empty")}), 6, "nothing was compared");
}

TEST_F(BotExitTest, WrongCellsAreNotOk) {
  // Blank pictures for player 1 at each of the first ticks.
  std::ofstream out(file("blank"));
  for (int tick = 1; tick < 2000; ++tick) {
    out << "tick " << tick << " player 1 80 24\n";
    for (int row = 0; row < 24; ++row) out << std::string(80, ' ') << '\n';
    for (int row = 0; row < 24; ++row) out << std::string(80, '.') << '\n';
    out << '\n';
  }
  out.close();
  expectEnd(*join({"--seconds", "1", "--truth", file("blank")}), 6, "wrong cells, the first at tick");
}

TEST_F(BotExitTest, AServerThatCrashedIsNotOk) {
  const auto bot = join({"--seconds", "3"});
  waitForPictures();
  m_server->signal(SIGKILL);
  expectEnd(*bot, 4, "dfbot: The ");
}

TEST_F(BotExitTest, AServerThatHangsIsNotOk) {
  const auto bot = join({"--seconds", "3"});
  waitForPictures();
  m_server->signal(SIGSTOP);
  expectEnd(*bot, 4, "sends nothing any more");
  m_server->signal(SIGCONT);
}

}  // namespace
}  // namespace naiad::test
