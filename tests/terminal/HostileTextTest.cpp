// The bytes that the real dfclient writes to its terminal when a server sends harmful texts wherever it can.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <string>
#include <vector>

#include "FakeServer.h"
#include "shared/values/Canvas.h"
#include "tests/support/HostileTexts.h"

namespace naiad::test {
namespace {

/// Parses a program's output like a terminal: printed characters and control sequences.
class Terminal {
 public:
  explicit Terminal(const std::string& output) {
    const std::u32string characters = df::decodeUtf8(output);
    for (std::size_t i = 0; i < characters.size();) i = take(characters, i);
  }
  /// Returns all drawable characters. strange() lists the control characters and sequences that neither
  /// ncurses nor the client needs.
  const std::u32string& printed() const { return m_printed; }
  const std::string& strange() const { return m_strange; }

 private:
  std::size_t take(const std::u32string& s, std::size_t i) {
    const char32_t ch = s[i];
    if (ch == U'\033') return sequence(s, i + 1);
    if (df::isDrawable(ch)) {
      m_printed.push_back(ch);
    } else if (ch != U'\r' && ch != U'\n' && ch != U'\b') {  // ncurses moves the cursor with these
      note("U+" + std::to_string(static_cast<unsigned>(ch)));
    }
    return i + 1;
  }

  // Parses CSI … with a final byte, or ESC with intermediates. Skips strings (OSC, DCS, APC, PM, SOS).
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
    // Allowed: cursor, erasing, scrolling, colours, modes, keyboard protocol (u), window title stack (t).
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

/// Joins several UTF-8 texts into a row, because each row starts a client. The last row has those not in
/// UTF-8.
std::vector<std::string> gathered() {
  constexpr std::size_t kEnough = 60;  // bytes; short enough to survive the limits of fields
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
  /// Checks that the client writes only control sequences that it would write for an honest server.
  static void expectHarmless(const PtyTerminal& terminal, const char* what) {
    const Terminal seen(terminal.output());
    EXPECT_EQ(seen.strange(), "") << what;
    for (const char* sequence :
         {"\033]", "\033P", "\033_", "\033c", "\033[6n", "\033[200~", "\033[>c", "OWNED\007"})
      EXPECT_FALSE(has(terminal.output(), sequence)) << what;
  }
};

TEST_F(HostileTextTest, ChatAndNamesCannotControlTheTerminal) {
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE"));
  int n = 0;
  for (const HostileText& hostile : hostileTexts()) {
    if (!isUtf8(hostile.bytes)) continue;  // such a text ends the session: another test below
    // Only changed cells are written, so all letters of consecutive marks must differ.
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
  terminal.type("\x1dp");  // opens the list of players
  ASSERT_TRUE(terminal.waitFor("layers"));
  terminal.type("\x1dq");
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 0);
  expectHarmless(terminal, "chat and names");
}

TEST_F(HostileTextTest, GoodbyesCannotControlTheTerminal) {
  for (const std::string& hostile : gathered()) {
    PtyTerminal terminal(options());
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE"));
    wire::ServerMessage goodbye;
    goodbye.mutable_goodbye()->set_message("LAST" + hostile);
    server.send(goodbye);
    EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 4) << terminal.newOutput();
    EXPECT_EQ(isUtf8(hostile), terminal.output().find("LAST") != std::string::npos);
    expectHarmless(terminal, "last words");
  }
}

TEST_F(HostileTextTest, WelcomesAndRefusalsCannotControlTheTerminal) {
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
      message.mutable_refused()->set_message("NO " + hostile);
    });
    PtyTerminal refused(options());
    EXPECT_NE(refused.waitForExit(), -1);
    expectHarmless(refused, "refusal");
  }
}

}  // namespace
}  // namespace naiad::test
