// The background colour of a game on the terminal of the real dfclient.
#include <gtest/gtest.h>

#include "FakeServerFixture.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad::test {
namespace {

wire::ServerMessage onBlue() {
  SnapshotHeader header;
  header.number = 2;
  header.tick = 101;
  SnapshotWriter out;
  out.beginSnapshot(header, 0, {});
  out.write(WorldRecord{{{}, {df::fromCells(80), df::fromCells(24)}}, 80, 24, df::BLUE});
  wire::ServerMessage message;
  message.set_snapshot(out.finish());
  return message;
}

using BackgroundTest = FakeServerFixture;

TEST_F(BackgroundTest, GameBackgroundReplacesTheTerminalsOwn) {
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  EXPECT_FALSE(has(terminal.output(), "\033[44m"));
  terminal.forget();
  server.send(onBlue());
  EXPECT_TRUE(terminal.waitFor("\033[44m")) << terminal.output();
  EXPECT_TRUE(terminal.waitFor("NAIAD-HERE")) << "everything is redrawn";
}

TEST_F(BackgroundTest, NoColorDisablesTheBackground) {
  PtyTerminal::Options with = options();
  with.environment["NO_COLOR"] = "1";
  PtyTerminal terminal(with);
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  server.send(onBlue());
  wire::ServerMessage chat;
  chat.mutable_chat()->set_text("after-that");
  server.send(chat);
  ASSERT_TRUE(terminal.waitFor("after-that")) << terminal.output();
  EXPECT_FALSE(has(terminal.output(), "\033[44m"));
}

}  // namespace
}  // namespace naiad::test
