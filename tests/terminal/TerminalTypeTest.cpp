// The real dfclient checks TERM before it connects to a server. It plays on terminals of every size that a
// visitor can request.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <string>
#include <utility>

#include "FakeServer.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {
namespace {

class TerminalTypeTest : public FakeServerFixture {
 protected:
  PtyTerminal::Options with(const std::string& term) const {
    PtyTerminal::Options options = this->options();
    options.environment["TERM"] = term;
    return options;
  }
  /// Makes the server show "WV" in blue, and waits until the terminal does.
  void drawBlue(PtyTerminal& terminal) {
    ObjectState state;
    state.motion = {100, {df::fromCells(30), df::fromCells(15)}, {}, {}};
    state.look.sequence = {{Glyph{0, 0, U'W', df::BLUE}, Glyph{256, 0, U'V', df::BLUE}}};
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    terminal.forget();
    server.sendWorld({state});
    ASSERT_TRUE(terminal.waitFor("WV")) << terminal.output();
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
  for (const auto& [p_term, p_sequence] :
       {std::pair{"xterm-256color", "\033[94mWV"}, {"xterm", ";1m\033[34mWV"}}) {
    PtyTerminal terminal(with(p_term));
    ASSERT_NO_FATAL_FAILURE(drawBlue(terminal));
    EXPECT_FALSE(has(terminal.output(), "not known"));
    EXPECT_TRUE(has(terminal.output(), p_sequence)) << ::testing::PrintToString(terminal.newOutput());
  }
}

/// Adds the terminal naiad-direct to a folder of descriptions. From `palette` on, its colours are mixtures.
void compileDirectTerminal(const std::string& folder, int palette) {
  const std::string first = std::to_string(palette);
  // Colours below 8, colours below `palette`, and mixtures.
  const auto color = [&first](const std::string& digit) {
    return "\\E[%?%p1%{8}%<%t" + digit + "%p1%d%e%?%p1%{" + first + "}%<%t" + digit + "8;5;%p1%d%e" + digit +
           "8:2::%p1%{65536}%/%d:%p1%{256}%/%{255}%&%d:%p1%{255}%&%d%;%;m";
  };
  std::ofstream(folder + "/source")
      << "naiad-direct|direct colours,\n\tam, bce, xenl, AX, RGB, colors#0x1000000, "
         "cols#80, lines#24, pairs#0x10000, CO#"
      << palette
      << ",\n\tbold=\\E[1m, clear=\\E[H\\E[2J, cup=\\E[%i%p1%d;%p2%dH, "
         "op=\\E[39;49m, rev=\\E[7m, sgr0=\\E[m,\n\tsetaf="
      << color("3") << ", setab=" << color("4") << ",\n";
  EXPECT_EQ(std::system(("tic -x -o " + folder + " " + folder + "/source").c_str()), 0);
}

TEST_F(TerminalTypeTest, DirectColorTerminalsGetTrueColors) {
  for (const int palette : {8, 256}) {
    PtyTerminal::Options with = this->with("naiad-direct");
    const TempFolder folder;
    compileDirectTerminal(folder.string(), palette);
    with.environment["TERMINFO"] = folder.string();
    PtyTerminal terminal(with);
    ASSERT_NO_FATAL_FAILURE(drawBlue(terminal));
    EXPECT_TRUE(has(terminal.output(), "38:2::122:162:255mWV"))
        << palette << testing::PrintToString(terminal.newOutput());
    // Each mixture is bright enough to be read.
    const std::string all = terminal.output();
    const std::regex mixture("38:2::([0-9]+):([0-9]+):([0-9]+)m");
    for (std::sregex_iterator it(all.begin(), all.end(), mixture); it != std::sregex_iterator(); ++it)
      EXPECT_GT(std::stoi((*it)[1]) + std::stoi((*it)[2]) + std::stoi((*it)[3]), 200) << it->str();
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

/// Returns an entry of /proc/PID/status, in MB: "VmRSS:" is resident memory, "VmData:" what a door limits.
int megabytes(pid_t process, const std::string& entry) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(entry)) return std::stoi(line.substr(entry.size())) / 1024;
  return -1;
}

class TerminalSizeTest : public FakeServerFixture {
 protected:
  PtyTerminal::Options sized(int columns, int rows) const {
    PtyTerminal::Options options = this->options();
    options.columns = columns;
    options.rows = rows;
    return options;
  }
  static void leave(PtyTerminal& terminal) {
    terminal.type("\x03");
    EXPECT_NE(terminal.waitForExit(), -1);
  }
};

constexpr int kMegabytes = 40;      ///< limit of a client's resident memory, whatever the terminal size
constexpr int kDataMegabytes = 64;  ///< limit of its data: half of what a door allows
constexpr std::pair<int, int> kLarge[] = {{65535, 65535}, {3000, 250}, {65535, 1}, {1, 65535}};

TEST_F(TerminalSizeTest, ALargeTerminalTakesBoundedMemory) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  for (const auto& [columns, rows] : kLarge) {
    PtyTerminal terminal(sized(columns, rows));
    ASSERT_TRUE(terminal.waitFor("\033[?u")) << columns << " x " << rows;
    EXPECT_LT(megabytes(terminal.pid(), "VmRSS:"), kMegabytes) << columns << " x " << rows;
    EXPECT_LT(megabytes(terminal.pid(), "VmData:"), kDataMegabytes) << columns << " x " << rows;
    leave(terminal);
  }
}

TEST_F(TerminalSizeTest, GrowingWindowTakesBoundedMemory) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  PtyTerminal terminal(sized(100, 30));
  ASSERT_TRUE(terminal.waitFor("NAIAD-HERE"));
  for (const auto& [columns, rows] : kLarge) {
    terminal.resize(columns, rows);
    // The client reports the new size after it has allocated the memory.
    const auto is_resize = [columns = columns, rows = rows](const wire::ClientMessage& m) {
      return m.has_resize() && static_cast<int>(m.resize().columns()) == std::min(columns, 640) &&
             static_cast<int>(m.resize().rows()) == std::min(rows, 256);
    };
    ASSERT_TRUE(server.hasReceived(is_resize)) << columns << " x " << rows;
    EXPECT_LT(megabytes(terminal.pid(), "VmRSS:"), kMegabytes) << columns << " x " << rows;
  }
  leave(terminal);
}

// Some terminal descriptions have no size.
TEST_F(TerminalSizeTest, EveryTerminalTypeReportsItsRealSize) {
  for (const char* type : {"linux", "vt100", "xterm-256color", "tmux-256color"}) {
    PtyTerminal::Options typed = sized(100, 30);
    typed.environment["TERM"] = type;
    typed.environment["COLUMNS"] = "40";  // exported by the user from another terminal
    typed.environment["LINES"] = "10";
    PtyTerminal terminal(typed);
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << type << terminal.output();
    EXPECT_TRUE(server.hasReceived([](const wire::ClientMessage& m) {
      return m.has_hello() && m.hello().columns() == 100 && m.hello().rows() == 30;
    })) << type;
    leave(terminal);
  }
}

// The terminal itself has no size here, so COLUMNS and LINES are used.
TEST_F(TerminalSizeTest, InvalidColumnsAndLinesTakeBoundedMemory) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  for (const char* number : {"30000", "99999999999999999999", "-5", "x"}) {
    PtyTerminal::Options without = sized(0, 0);
    without.environment["COLUMNS"] = number;
    without.environment["LINES"] = number;
    PtyTerminal terminal(without);
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << number;
    EXPECT_LT(megabytes(terminal.pid(), "VmRSS:"), kMegabytes) << number;
    leave(terminal);
  }
}

}  // namespace
}  // namespace naiad::test
