// The real dfclient, and a server that has no time for it at first.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <string>

#include "FakeServer.h"
#include "PtyTerminal.h"

namespace naiad::test {
namespace {

class BusyServerTest : public testing::Test {
 protected:
  /// Refuses so many hellos.
  void refuse(int times, wire::Refused::Reason reason) {
    server.onWelcome([this, times, reason](wire::ServerMessage& message) {
      if (++hellos > times) return;
      message.mutable_refused()->set_reason(reason);
      message.mutable_refused()->set_sentence("Not now, please.");
    });
  }
  PtyTerminal::Options options() const {
    PtyTerminal::Options options;
    options.command = {programPath("dfclient"), server.address(), "--insecure", "--name", "Ada"};
    return options;
  }
  static int count(const std::string& text, const std::string& what) {
    int found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  }

  std::atomic<int> hellos = 0;
  FakeServer server;
};

TEST_F(BusyServerTest, IsAskedAgainAndItsSentenceIsShownOnce) {
  refuse(3, wire::Refused::BUSY);
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  EXPECT_EQ(hellos, 4);
  EXPECT_EQ(count(terminal.output(), "dfclient: Not now, please. (Trying again; Ctrl-C ends.)"), 1)
      << terminal.output();
}

TEST_F(BusyServerTest, OtherRefusalsAreFinal) {
  refuse(3, wire::Refused::FULL);
  PtyTerminal terminal(options());
  const int status = terminal.waitForExit();
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_EQ(hellos, 1);
  EXPECT_NE(terminal.output().find("dfclient: Not now, please.\r\n"), std::string::npos) << terminal.output();
}

TEST_F(BusyServerTest, ControlCEndsTheWait) {
  refuse(1'000'000, wire::Refused::BUSY);
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("Trying again"));
  terminal.type("\x03");
  const int status = terminal.waitForExit();
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
}

}  // namespace
}  // namespace naiad::test
