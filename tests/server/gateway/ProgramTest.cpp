// The program dfweb: its command line, its output and its exit.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "FakeGame.h"
#include "WebClient.h"
#include "tests/support/RunningProgram.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

class DfwebProgram : public testing::Test {
 protected:
  /// Expects this exit code and this text in the output.
  static void expectRefusal(std::vector<std::string> words, int code, const std::string& text) {
    words.insert(words.begin(), "dfweb");
    RunningProgram dfweb(words);
    EXPECT_EQ(dfweb.finish(), code) << text;
    EXPECT_TRUE(has(dfweb.printed(), text));
  }

  GatewayHome home;
  const std::string link = "naiad://game.test#aaaaaaaaaaaaaaaaaaaaaaaaaa";
  const std::string page = home.path("page").string();
};

TEST_F(DfwebProgram, InvalidOptionsPrintAMessageAndSetExitCode) {
  expectRefusal({"--help"}, 0, "--proxy-socket");
  expectRefusal({}, 2, "link");
  expectRefusal({"http://game.test", "--proxy-socket", "visitors"}, 2, "naiad://");
  expectRefusal({link}, 2, "--proxy-socket is required");
  expectRefusal({link, "--proxy-socket", std::string(200, 'v')}, 2, "too long");
  expectRefusal({link, "--proxy-socket", "visitors", "--certificate", "certificate"}, 2, "together");
  expectRefusal({link, "--proxy-socket", "visitors", "--listen", "localhost:80"}, 2, "ADDRESS:PORT");
  expectRefusal({link, "--proxy-socket", "visitors", "--origin", "https://a/b"}, 2, "https://NAME");
  expectRefusal({link, "--proxy-socket", "visitors", "--proxy-for", "x"}, 2,
                "there is no option --proxy-for");
  expectRefusal({link, "--proxy-socket", "visitors", "--page", home.path("none")}, 3, "page");
  expectRefusal({link, "--proxy-socket", "visitors", "--page", home.path("page/folder")}, 3, "index.html");
  expectRefusal({link, "--proxy-socket", "visitors", "--page", page, "--listen", "0.0.0.0:0"}, 4, "loopback");
}

TEST_F(DfwebProgram, PrintsTheAddressForPlayersAndEndsInOrder) {
  FakeGame game(home.path("identity"), home.path("visitors"));
  const std::string real = "naiad://game.test#" + game.key().text();
  RunningProgram dfweb({"dfweb", real, "--proxy-socket", home.path("visitors"), "--page", page, "--listen",
                        "127.0.0.1:0", "--port-file", home.path("port"), "--origin", "https://play.example",
                        "--origin", "https://two.example"});
  ASSERT_TRUE(dfweb.prints("connects browsers")) << dfweb.printed();
  std::uint16_t port = 0;
  std::ifstream(home.path("port")) >> port;
  EXPECT_TRUE(has(dfweb.printed(), "Players open https://play.example/#" + game.key().text()));
  EXPECT_TRUE(has(dfweb.printed(), "Players open https://two.example/#" + game.key().text()));
  EXPECT_TRUE(has(dfweb.printed(),
                  "Players open http://127.0.0.1:" + std::to_string(port) + "/#" + game.key().text()));
  WebClient browser(port);
  EXPECT_EQ(browser.ask("/")->body, indexText());
  WebClient player(port);
  ASSERT_TRUE(player.play());
  player.sendFrame(2, "hello");
  ASSERT_EQ(player.frame()->payload, "hello");
  dfweb.signal(SIGTERM);
  EXPECT_EQ(player.waitForClose(), 1001);
  EXPECT_EQ(dfweb.finish(), 0);
  EXPECT_TRUE(has(dfweb.printed(), "played=1"));
}

}  // namespace
}  // namespace naiad::test
