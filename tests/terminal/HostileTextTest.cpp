// A server that says everything a terminal can be harmed with, wherever it may speak; and the bytes that the
// real dfclient writes to its terminal.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <string>
#include <vector>

#include "FakeServerFixture.h"
#include "shared/values/Canvas.h"
#include "tests/support/HostileTexts.h"

namespace naiad::test {
namespace {

/// Takes apart what a program writes, as a terminal would: what is printed, and what sequences there are.
class Terminal {
 public:
  explicit Terminal(const std::string& output) {
    const std::u32string characters = df::decodeUtf8(output);
    for (std::size_t i = 0; i < characters.size();) i = take(characters, i);
  }
  /// Everything that was printed, and that is none of: a drawable character, a line's end, a sequence of
  /// those that ncurses and the client need.
  const std::u32string& printed() const { return m_printed; }
  const std::string& strange() const { return m_strange; }

 private:
  std::size_t take(const std::u32string& s, std::size_t i) {
    const char32_t ch = s[i];
    if (ch == U'\033') return sequence(s, i + 1);
    if (df::isDrawable(ch)) {
      m_printed.push_back(ch);
    } else if (ch != U'\r' && ch != U'\n' && ch != U'\b') {  // ncurses moves the cursor by these
      note("U+" + std::to_string(static_cast<unsigned>(ch)));
    }
    return i + 1;
  }

  // CSI … with a final byte, or ESC with intermediates. Strings (OSC, DCS, APC, PM, SOS) are not
  // looked at.
  std::size_t sequence(const std::u32string& s, std::size_t i) {
    if (i >= s.size()) return i;
    std::string text(1, static_cast<char>(s[i]));
    if (s[i] != U'[') {
      if ((text == "(" || text == ")") && i + 1 < s.size()) text.push_back(static_cast<char>(s[++i]));
      if (text != "(B" && text != ")0" && text != "=" && text != ">" && text != "7" && text != "8" &&
          text != "M") {
        note("ESC " + text);
      }
      return i + 1;
    }
    std::size_t k = i + 1;
    while (k < s.size() && s[k] >= 0x20 && s[k] < 0x40) text.push_back(static_cast<char>(s[k++]));
    const char final = k < s.size() ? static_cast<char>(s[k]) : 'm';
    // Cursor, erasing, scrolling, colours, modes, keyboard protocol (u), window title stack (t).
    if (std::string("ABCDGHJKLMPXabcdhlmrtuSTZ@").find(final) == std::string::npos)
      note("CSI " + text + final);
    return k + 1;
  }
  void note(const std::string& what) { m_strange += what + '\n'; }

  std::u32string m_printed;
  std::string m_strange;
};

bool isUtf8(const std::string& bytes) {
  wire::ClientMessage message;
  message.mutable_chat()->set_text(bytes);
  return wire::ClientMessage().ParseFromString(message.SerializeAsString());
}

/// Several of those that are UTF-8 in a row, since a program is started for each; and all the others.
std::vector<std::string> gathered() {
  constexpr std::size_t kEnough = 60;  // bytes: what is cut to its length still holds it
  std::vector<std::string> rows(1);
  std::string others;
  for (const HostileText& hostile : hostileTexts()) {
    if (!isUtf8(hostile.bytes)) {
      others += hostile.bytes;
      continue;
    }
    if (rows.back().size() + hostile.bytes.size() > kEnough && !rows.back().empty()) rows.emplace_back();
    rows.back() += hostile.bytes;
  }
  rows.push_back(others);
  return rows;
}

class HostileTextTest : public FakeServerFixture {
 protected:
  /// What the client may write by itself is what it writes with an honest server.
  static void expectHarmless(const PtyTerminal& terminal, const char* what) {
    const Terminal seen(terminal.output());
    EXPECT_EQ(seen.strange(), "") << what;
    for (const char* sequence :
         {"\033]", "\033P", "\033_", "\033c", "\033[6n", "\033[200~", "\033[>c", "OWNED\007"})
      EXPECT_FALSE(has(terminal.output(), sequence)) << what;
  }
};

TEST_F(HostileTextTest, ChatAndNamesOfEveryClassReachTheTerminalHarmless) {
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE"));
  int n = 0;
  for (const HostileText& hostile : hostileTexts()) {
    if (!isUtf8(hostile.bytes)) continue;  // no message, which ends the session: see below
    // Only cells that change are written, so no letter of it may be where one of the last mark was.
    const std::string mark(4, static_cast<char>('A' + n++ % 26));
    terminal.forget();
    wire::ServerMessage players;
    wire::PlayerEntry& entry = *players.mutable_players()->add_players();
    entry.set_player(9);
    entry.set_name(hostile.bytes);
    server.send(players);
    wire::ServerMessage chat;
    chat.mutable_chat()->set_player(9);
    chat.mutable_chat()->set_text(mark + hostile.bytes);
    server.send(chat);
    ASSERT_TRUE(terminal.waitFor(mark)) << hostile.what;
  }
  terminal.type("\x1dp");  // the list of players
  ASSERT_TRUE(terminal.waitFor("layers"));
  terminal.type("\x1dq");
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 0);
  expectHarmless(terminal, "chat and names");
}

TEST_F(HostileTextTest, GoodbyesOfEveryClassReachTheTerminalHarmless) {
  for (const std::string& hostile : gathered()) {
    PtyTerminal terminal(options());
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE"));
    wire::ServerMessage goodbye;
    goodbye.mutable_goodbye()->set_sentence("LAST" + hostile);
    server.send(goodbye);
    EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 4) << terminal.newOutput();
    EXPECT_EQ(isUtf8(hostile), terminal.output().find("LAST") != std::string::npos);
    expectHarmless(terminal, "last words");
  }
}

TEST_F(HostileTextTest, WelcomesAndRefusalsAreHarmlessToo) {
  for (const std::string& hostile : gathered()) {
    server.onWelcome([&hostile](wire::ServerMessage& message) {
      wire::Welcome& welcome = *message.mutable_welcome();
      welcome.set_name(hostile);
      welcome.set_game(hostile);
      welcome.set_server(hostile);
      welcome.set_help(0, "HELP" + hostile);
    });
    PtyTerminal playing(options());
    if (isUtf8(hostile)) {
      ASSERT_TRUE(playing.waitFor("NAIAD-HERE"));
      playing.type("\x1dh");
      EXPECT_TRUE(playing.waitFor("HELP"));
      playing.type("\x1dq");
    }
    EXPECT_NE(playing.waitForExit(), -1);
    expectHarmless(playing, "welcome");

    server.onWelcome([&hostile](wire::ServerMessage& message) {
      message.mutable_refused()->set_reason(wire::Refused::FULL);
      message.mutable_refused()->set_sentence("NO " + hostile);
    });
    PtyTerminal refused(options());
    EXPECT_NE(refused.waitForExit(), -1);
    expectHarmless(refused, "refusal");
  }
}

}  // namespace
}  // namespace naiad::test
