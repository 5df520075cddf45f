// The bytes that the real dfclient writes to its terminal when the game plays sounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "FakeServerFixture.h"

namespace naiad::test {
namespace {

class TerminalSoundTest : public FakeServerFixture {
 protected:
  PtyTerminal::Options with(const std::string& mode) const {
    PtyTerminal::Options options = this->options();
    if (!mode.empty()) options.command.insert(options.command.end(), {"--sound", mode});
    return options;
  }
  /// Plays many sounds, then waits for a chat line that was sent after them.
  void play(PtyTerminal& terminal) {
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
  }
  static auto bells(const PtyTerminal& terminal) { return std::ranges::count(terminal.output(), '\a'); }
};

TEST_F(TerminalSoundTest, ShowsANoteByDefault) {
  PtyTerminal terminal(with(""));
  play(terminal);
  EXPECT_TRUE(terminal.waitFor("sound: pew"));
  EXPECT_EQ(bells(terminal), 0);
}

TEST_F(TerminalSoundTest, FiftySoundsRingTheBellAtMostThreeTimes) {
  PtyTerminal terminal(with("bell"));
  play(terminal);
  EXPECT_TRUE(terminal.waitFor("sound: pew"));
  EXPECT_TRUE(terminal.waitFor("\a"));
  EXPECT_LE(bells(terminal), 3) << "fifty sounds within a moment";
}

TEST_F(TerminalSoundTest, IsNothingIfSwitchedOff) {
  PtyTerminal terminal(with("off"));
  play(terminal);
  EXPECT_FALSE(has(terminal.output(), "pew"));
  EXPECT_EQ(bells(terminal), 0);
}

}  // namespace
}  // namespace naiad::test
