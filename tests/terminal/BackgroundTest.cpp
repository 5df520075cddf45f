// The background colour and the sounds of a game on the terminal of the real dfclient.
#include <gtest/gtest.h>

#include <algorithm>

#include "FakeServer.h"
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

using TerminalSoundTest = FakeServerFixture;

/// Fifty sounds within a moment, then a chat line that was sent after them.
TEST_F(TerminalSoundTest, ModesDecideOnTheNoteAndTheBell) {
  const struct {
    const char* mode;
    bool has_note;
    bool has_bell;
  } rows[] = {{"note", true, false}, {"bell", true, true}, {"off", false, false}, {nullptr, true, false}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.mode != nullptr ? row.mode : "the default");
    PtyTerminal::Options with = options();
    if (row.mode != nullptr) with.command.insert(with.command.end(), {"--sound", row.mode});
    PtyTerminal terminal(with);
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    terminal.forget();
    for (int i = 0; i < 50; ++i) {
      wire::ServerMessage message;
      message.mutable_sounds()->add_sounds()->set_label("pew");
      server.send(message);
    }
    wire::ServerMessage chat;
    chat.mutable_chat()->set_text("that-was-loud");
    server.send(chat);
    ASSERT_TRUE(terminal.waitFor("that-was-loud")) << terminal.output();
    EXPECT_TRUE(!row.has_note || terminal.waitFor("sound: pew"));
    EXPECT_TRUE(!row.has_bell || terminal.waitFor("\a"));
    EXPECT_EQ(has(terminal.output(), "pew"), row.has_note);
    EXPECT_LE(std::ranges::count(terminal.output(), '\a'), row.has_bell ? 3 : 0);
  }
}

}  // namespace
}  // namespace naiad::test
