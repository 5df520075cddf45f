// The real dfclient and a server that lets it in and sends no picture.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include "FakeServer.h"
#include "PtyTerminal.h"

namespace naiad::test {
namespace {

TEST(NoPicture, TheClientSaysWhatItWaitsForAndLeavesWhenAsked) {
  FakeServer server;
  server.withholdPictures();
  PtyTerminal::Options options;
  options.command = {programPath("dfclient"), server.address(), "--insecure", "--name", "Ada"};
  PtyTerminal terminal(options);
  ASSERT_TRUE(terminal.waitFor("first picture is awaited")) << terminal.output();
  terminal.type("\x03");
  const int status = terminal.waitForExit();
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
  EXPECT_TRUE(server.hasReceived([](const wire::ClientMessage& m) { return m.has_leave(); }))
      << "no place is kept for it";
  EXPECT_EQ(terminal.output().find('\033'), std::string::npos) << "the terminal was not touched";
}

TEST(NoPicture, AServerThatIsGoneBeforeItIsSaid) {
  FakeServer server;
  server.withholdPictures();
  server.onWelcome([](wire::ServerMessage& message) {
    message.mutable_welcome()->set_resume_token("0123456789abcdef");  // so it could be gone on with
  });
  PtyTerminal::Options options;
  options.command = {programPath("dfclient"), server.address(), "--insecure", "--name", "Ada"};
  PtyTerminal terminal(options);
  ASSERT_TRUE(server.hasReceived([](const wire::ClientMessage& m) { return m.has_ping(); }));
  server.drop();
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 1);
  EXPECT_NE(terminal.output().find("lost before its first picture"), std::string::npos) << terminal.output();
}

}  // namespace
}  // namespace naiad::test
