// The real dfclient checks TERM before it connects to a server.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "FakeServerFixture.h"

namespace naiad::test {
namespace {

class TerminalTypeTest : public FakeServerFixture {
 protected:
  PtyTerminal::Options with(const std::string& term) const {
    PtyTerminal::Options options = this->options();
    options.environment["TERM"] = term;
    return options;
  }
};

TEST_F(TerminalTypeTest, UnknownTypeIsDrawnAsXterm) {
  for (const char* p_term : {"xterm-kitty-nonesuch", "ghostty-nonesuch"}) {
    PtyTerminal terminal(with(p_term));
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    EXPECT_TRUE(terminal.waitFor(std::string("TERM=") + p_term + " is not known")) << terminal.output();
    EXPECT_TRUE(terminal.waitFor("using xterm-256color"));
    terminal.type("\x03");
    EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 0);
    EXPECT_TRUE(sameModes(terminal.originalModes(), terminal.currentModes()));
  }
}

TEST_F(TerminalTypeTest, KnownTypeGivesNoWarning) {
  PtyTerminal terminal(with("xterm"));
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  EXPECT_FALSE(has(terminal.output(), "not known"));
}

TEST_F(TerminalTypeTest, UnusableTypeFailsBeforeConnecting) {
  for (const char* p_term : {"dumb", "unknown", ""}) {
    PtyTerminal terminal(with(p_term));
    EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 5) << terminal.output();
    EXPECT_TRUE(has(terminal.output(), "dfclient: TERM"));
    EXPECT_FALSE(has(terminal.output(), "\033")) << "the terminal was not touched";
  }
  EXPECT_EQ(server.connections(), 0);
}

TEST_F(TerminalTypeTest, TypeNameIsSanitized) {
  PtyTerminal terminal(with("x\033]0;OWNED\007" + std::string(300, 'y')));
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
  ASSERT_TRUE(terminal.waitFor("is not known")) << terminal.output();
  EXPECT_FALSE(has(terminal.output(), "\033]"));
}

TEST_F(TerminalTypeTest, DarkBlueIsDrawnBright) {
  ObjectState state;
  state.motion = {100, {df::fromCells(30), df::fromCells(15)}, {}, {}};
  state.look.sequence = {{Glyph{0, 0, U'W', df::BLUE}, Glyph{256, 0, U'V', df::BLUE}}};
  for (const auto& [p_term, p_sequence] :
       {std::pair{"xterm-256color", "\033[94mWV"}, {"xterm", ";1m\033[34mWV"}}) {
    PtyTerminal terminal(with(p_term));
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    terminal.forget();
    server.sendWorld({state});
    ASSERT_TRUE(terminal.waitFor("WV")) << terminal.output();
    EXPECT_TRUE(has(terminal.output(), p_sequence)) << ::testing::PrintToString(terminal.newOutput());
  }
}

TEST_F(TerminalTypeTest, PastedTextWaitsInTheChatLine) {
  PtyTerminal terminal(with("xterm-256color"));
  ASSERT_TRUE(terminal.waitFor("\033[?2004h")) << terminal.output();
  terminal.type("\033[200~not-for-the-game\r\033[201~");
  terminal.type("\x1dt");
  ASSERT_TRUE(terminal.waitFor("say: ")) << terminal.output();
  terminal.type("see \033[200~https://example.org/a\r\nand more\033[201~");
  ASSERT_TRUE(terminal.waitFor("and more")) << terminal.output();
  terminal.type("!\r");
  EXPECT_TRUE(server.hasReceived([](const wire::ClientMessage& m) {
    return m.has_chat() && m.chat().text() == "see https://example.org/a and more!";
  }));
}

}  // namespace
}  // namespace naiad::test
