// dfweb as it is run: its command line, what it prints, and its end.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "FakeGame.h"
#include "GatewayRun.h"
#include "WebClient.h"

namespace naiad::test {
namespace {

/// dfweb with these words, and what it prints on stdout and stderr.
class Dfweb {
 public:
  explicit Dfweb(std::vector<std::string> words) {
    words.insert(words.begin(), NAIAD_BINARY_DIR "/dfweb");
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    m_child = fork();
    if (m_child == 0) {
      std::vector<char*> pointers;
      for (std::string& word : words) pointers.push_back(word.data());
      pointers.push_back(nullptr);
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      execv(pointers[0], pointers.data());
      _exit(127);
    }
    close(ends[1]);
    m_output = ends[0];
  }
  ~Dfweb() {
    if (m_child > 0) kill(m_child, SIGKILL);
    finish();
  }
  Dfweb(const Dfweb&) = delete;
  Dfweb& operator=(const Dfweb&) = delete;

  /// Read until this was printed, or the end.
  bool prints(const std::string& text) {
    char bytes[512];
    while (m_printed.find(text) == std::string::npos) {
      const auto got = read(m_output, bytes, sizeof bytes);
      if (got <= 0) return false;
      m_printed.append(bytes, static_cast<std::size_t>(got));
    }
    return true;
  }
  void signal(int number) const { kill(m_child, number); }
  /// Read to the end; the exit code.
  int finish() {
    if (m_child <= 0) return m_code;
    prints(std::string("\0", 1));
    close(m_output);
    int status = 0;
    waitpid(m_child, &status, 0);
    m_child = 0;
    return m_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  const std::string& printed() const { return m_printed; }

 private:
  pid_t m_child = 0;
  int m_output = -1;
  int m_code = -1;
  std::string m_printed;
};

class DfwebProgram : public testing::Test {
 protected:
  /// The exit code, and whether it said this.
  static void expectRefusal(const std::vector<std::string>& words, int code, const std::string& text) {
    Dfweb dfweb(words);
    EXPECT_EQ(dfweb.finish(), code) << text;
    EXPECT_NE(dfweb.printed().find(text), std::string::npos) << dfweb.printed();
  }

  GatewayHome home;
  const std::string link = "naiad://game.test#aaaaaaaaaaaaaaaaaaaaaaaaaa";
  const std::string page = home.path("page").string();
};

TEST_F(DfwebProgram, WhatIsWrongIsASentenceAndACode) {
  expectRefusal({"--help"}, 0, "--visitors");
  expectRefusal({}, 2, "link");
  expectRefusal({"http://game.test", "--visitors", "visitors"}, 2, "naiad://");
  expectRefusal({link}, 2, "--visitors is wanted");
  expectRefusal({link, "--visitors", std::string(200, 'v')}, 2, "too long");
  expectRefusal({link, "--visitors", "visitors", "--certificate", "certificate"}, 2, "together");
  expectRefusal({link, "--visitors", "visitors", "--listen", "localhost:80"}, 2, "ADDRESS:PORT");
  expectRefusal({link, "--visitors", "visitors", "--origin", "https://a/b"}, 2, "https://NAME");
  expectRefusal({link, "--visitors", "visitors", "--visitor", "x"}, 2, "--visitors");
  expectRefusal({link, "--visitors", "visitors", "--page", home.path("none")}, 3, "page");
  expectRefusal({link, "--visitors", "visitors", "--page", home.path("page/folder")}, 3, "index.html");
  expectRefusal({link, "--visitors", "visitors", "--page", page, "--listen", "0.0.0.0:0"}, 4, "loopback");
}

TEST_F(DfwebProgram, PrintsTheAddressForPlayersAndEndsInOrder) {
  FakeGame game(home.path("identity"), home.path("visitors"));
  const std::string real = "naiad://game.test#" + game.key().text();
  Dfweb dfweb({real, "--visitors", home.path("visitors"), "--page", page, "--listen", "127.0.0.1:0",
               "--port-file", home.path("port"), "--origin", "https://play.example"});
  ASSERT_TRUE(dfweb.prints("leads browsers")) << dfweb.printed();
  std::uint16_t port = 0;
  std::ifstream(home.path("port")) >> port;
  EXPECT_NE(dfweb.printed().find("Players open https://play.example/#" + game.key().text()),
            std::string::npos);
  EXPECT_NE(dfweb.printed().find("Players open http://127.0.0.1:" + std::to_string(port) + "/#" +
                                 game.key().text()),
            std::string::npos)
      << dfweb.printed();
  WebClient browser(port);
  EXPECT_EQ(browser.ask("/")->body, indexText());
  WebClient player(port);
  ASSERT_TRUE(player.play());
  player.sendFrame(2, "hello");
  ASSERT_EQ(player.frame()->payload, "hello");
  dfweb.signal(SIGTERM);
  EXPECT_EQ(player.waitForClose(), 1001);
  EXPECT_EQ(dfweb.finish(), 0);
  EXPECT_NE(dfweb.printed().find("played=1"), std::string::npos) << dfweb.printed();
}

}  // namespace
}  // namespace naiad::test
