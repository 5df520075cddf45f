// The real dfclient on terminals of every size that a visitor can request.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

#include "FakeServerFixture.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

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
