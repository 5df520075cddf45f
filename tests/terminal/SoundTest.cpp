// The bytes that the real dfclient writes to its terminal when the game plays sounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "FakeServerFixture.h"

namespace naiad::test {
namespace {

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
