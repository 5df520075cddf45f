// The real dfbot reports ok only if the server stayed to the end and all pictures were compared.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <memory>

#include "HomeFixture.h"

namespace naiad::test {
namespace {

class BotExitTest : public HomeFixture {
 protected:
  BotExitTest() {
    serve("hello", {"--insecure", "--seed", "1", "--port-file", file("port"), "--truth-file", file("truth")});
  }

  std::string file(const char* name) const { return m_home / name; }
  /// Starts a bot and waits until the server has accepted it.
  std::unique_ptr<PtyTerminal> join(const std::vector<std::string>& more) {
    std::string port;
    EXPECT_TRUE(m_server->waitUntil([&] { return static_cast<bool>(std::ifstream(file("port")) >> port); }));
    auto bot = std::make_unique<PtyTerminal>(
        inHome({programPath("dfbot"), "127.0.0.1:" + port, "--insecure", "--quiet"}, more));
    EXPECT_TRUE(m_server->waitFor("\"bot\" joined")) << m_server->output();
    return bot;
  }
  /// Waits until the server has sent the bot pictures.
  void waitForPictures() {
    EXPECT_TRUE(m_server->waitUntil([&] {
      std::ifstream in(file("truth"));
      int ticks = 0;
      for (std::string line; std::getline(in, line);) ticks += line.rfind("tick ", 0) == 0 ? 1 : 0;
      return ticks >= 10;
    }));
  }
  static void expectEnd(PtyTerminal& bot, int code, const std::string& sentence) {
    HomeFixture::expectEnd(bot, code, sentence);
    EXPECT_EQ(has(bot.output(), "bot ok"), code == 0) << bot.output();
  }
};

TEST_F(BotExitTest, FolderIsRejectedAsAScript) {
  PtyTerminal bot(inHome({programPath("dfbot"), "127.0.0.1:1", "--insecure", "--script", m_home.string()}));
  expectEnd(bot, 2, "dfbot: --script: " + m_home.string() + " is a folder");
}

TEST_F(BotExitTest, MatchingPicturesAreOk) {
  expectEnd(*join({"--seconds", "1", "--truth-file", file("truth")}), 0, "wrong_cells=0");
}

TEST_F(BotExitTest, NothingComparedIsNotOk) {
  std::ofstream(file("empty"));
  expectEnd(*join({"--seconds", "1", "--truth-file", file("empty")}), 6, "nothing was compared");
}

TEST_F(BotExitTest, WrongCellsAreNotOk) {
  // Blank pictures for player 1 in each of the first ticks.
  std::ofstream out(file("blank"));
  for (int tick = 1; tick < 2000; ++tick) {
    out << "tick " << tick << " player 1 80 24\n";
    for (int row = 0; row < 24; ++row) out << std::string(80, ' ') << '\n';
    for (int row = 0; row < 24; ++row) out << std::string(80, '.') << '\n';
    out << '\n';
  }
  out.close();
  expectEnd(*join({"--seconds", "1", "--truth-file", file("blank")}), 6, "wrong cells, the first at tick");
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
  expectEnd(*bot, 4, "stopped sending snapshots");
  m_server->signal(SIGCONT);
}

}  // namespace
}  // namespace naiad::test
