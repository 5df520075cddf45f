// The real dfclient with a server that is busy at first, or sends no picture.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>

#include "FakeServer.h"

namespace naiad::test {
namespace {

class BusyServerTest : public FakeServerFixture {
 protected:
  /// Refuses this many hellos.
  void refuse(int times, wire::Refused::Reason reason) {
    server.onWelcome([hellos = hellos, times, reason](wire::ServerMessage& message) {
      if (++*hellos > times) return;
      message.mutable_refused()->set_reason(reason);
      message.mutable_refused()->set_message("Not now, please.");
    });
  }

  std::shared_ptr<std::atomic<int>> hellos = std::make_shared<std::atomic<int>>(0);
};

TEST_F(BusyServerTest, IsRetriedAndItsMessageShownOnce) {
  refuse(3, wire::Refused::BUSY);
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  EXPECT_EQ(*hellos, 4);
  EXPECT_EQ(countIn(terminal.output(), "dfclient: Not now, please. (Retrying; Ctrl-C quits.)"), 1)
      << terminal.output();
}

TEST_F(BusyServerTest, OtherRefusalsAreFinal) {
  refuse(3, wire::Refused::FULL);
  PtyTerminal terminal(options());
  EXPECT_TRUE(exits(terminal, 3));
  EXPECT_EQ(*hellos, 1);
  EXPECT_TRUE(has(terminal.output(), "dfclient: Not now, please.\r\n"));
}

TEST_F(BusyServerTest, ControlCEndsTheWait) {
  refuse(1'000'000, wire::Refused::BUSY);
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("Retrying"));
  terminal.type("\x03");
  EXPECT_TRUE(diesOf(terminal, SIGINT));
}

using NoPicture = FakeServerFixture;

TEST_F(NoPicture, WaitIsReportedAndControlCLeaves) {
  server.withholdPictures();
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("waiting for the first picture")) << terminal.output();
  terminal.type("\x03");
  EXPECT_TRUE(diesOf(terminal, SIGINT));
  EXPECT_TRUE(server.hasReceived([](const wire::ClientMessage& m) { return m.has_leave(); }))
      << "no place is kept for it";
  EXPECT_FALSE(has(terminal.output(), "\033")) << "the terminal was not touched";
}

TEST_F(NoPicture, LostServerEndsTheClientWithAMessage) {
  server.withholdPictures();
  server.onWelcome([](wire::ServerMessage& message) {
    message.mutable_welcome()->set_resume_token("0123456789abcdef");  // so that the session could be resumed
  });
  PtyTerminal terminal(options());
  ASSERT_TRUE(server.hasReceived([](const wire::ClientMessage& m) { return m.has_ping(); }));
  server.drop();
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 1);
  EXPECT_TRUE(has(terminal.output(), "lost before its first picture"));
}

}  // namespace
}  // namespace naiad::test
