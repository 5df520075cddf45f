// The real dfclient with a server that accepts it and sends no picture.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include "FakeServerFixture.h"

namespace naiad::test {
namespace {

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
