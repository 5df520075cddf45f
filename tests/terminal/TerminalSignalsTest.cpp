// The real dfclient restores the terminal when signals in quick succession end it at any moment.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <string>

#include "FakeServer.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

using std::chrono::microseconds;

/// Returns the modes that the client has switched on and not off again; empty if none.
std::string modesLeftOn(const std::string& output) {
  std::string left;
  for (const std::string mode : {"?1049", "?1003", "?1006", "?2004", "?1004", "?9001"}) {
    const std::size_t on = output.rfind("\033[" + mode + "h");
    const std::size_t off = output.rfind("\033[" + mode + "l");
    if (on != std::string::npos && (off == std::string::npos || off < on)) left += mode + " ";
  }
  const std::size_t hidden = output.rfind("\033[?25l");
  if (hidden != std::string::npos && output.find("\033[?25h", hidden) == std::string::npos) left += "cursor ";
  const std::size_t pushed = output.rfind("\033[>31u");
  if (pushed != std::string::npos && output.find("\033[<u", pushed) == std::string::npos) left += "kitty ";
  return left;
}

/// Sends terminating signals at random intervals. Returns the wait status of the program.
int endBySignals(PtyTerminal& terminal, std::mt19937& random) {
  constexpr std::array kSignals{SIGTERM, SIGHUP, SIGINT};
  std::uniform_int_distribution<int> gap(0, 80);
  for (int i = 0; i < 40; ++i) {
    terminal.signal(kSignals[random() % kSignals.size()]);
    const auto until = std::chrono::steady_clock::now() + microseconds(gap(random));
    while (std::chrono::steady_clock::now() < until) {
    }
  }
  return terminal.waitForExit();
}

int tries() {
  return std::getenv("NAIAD_LONG_TESTS") != nullptr ? 300 : 20 / kShare;
}

class TerminalSignalsTest : public FakeServerFixture {
 protected:
  PtyTerminal::Options shell() const {
    PtyTerminal::Options shell = options();
    shell.command = {"/bin/bash", "--norc", "--noprofile", "--noediting", "-i"};
    shell.environment["PS1"] = "ready$ ";
    return shell;
  }
  /// Runs the client in the shell and presses Ctrl-Z, encoded as in the keyboard protocol.
  void playAndSuspend(PtyTerminal& terminal, const std::string& wrapper = "") const {
    ASSERT_TRUE(terminal.waitFor("ready$ "));
    terminal.type("echo before-$(stty -g); ");
    std::string command;
    for (const std::string& word : options().command) command += word + " ";
    terminal.type(wrapper.empty() ? command : wrapper + " '" + command + "; true'");
    terminal.type("\n");
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    ASSERT_TRUE(terminal.waitFor("\033[>31u"));
    terminal.forget();
    terminal.type("\033[122;5u");
    ASSERT_TRUE(terminal.waitFor("ready$ ")) << terminal.output();
  }
  PtyTerminal::Options options() const {
    PtyTerminal::Options options = FakeServerFixture::options();
    options.answer_kitty = true;
    return options;
  }
  static void expectRestored(PtyTerminal& terminal, int attempt) {
    EXPECT_EQ(modesLeftOn(terminal.output()), "")
        << attempt << ": "
        << terminal.output().substr(terminal.output().size() -
                                    std::min<std::size_t>(terminal.output().size(), 200));
    EXPECT_TRUE(sameModes(terminal.originalModes(), terminal.currentModes())) << attempt;
  }
  /// Ends clients by signals, each when `reach` has brought it to the right moment.
  template <class Reach>
  void endOften(const PtyTerminal::Options& client, Reach reach) {
    for (int i = 0; i < tries() && !HasFailure(); ++i) {
      PtyTerminal terminal(client);
      ASSERT_TRUE(reach(terminal, i)) << terminal.output();
      EXPECT_NE(endBySignals(terminal, random), -1);
      expectRestored(terminal, i);
    }
  }

  std::mt19937 random{4711};
};

TEST_F(TerminalSignalsTest, SignalsDuringTheGameRestoreTheTerminal) {
  endOften(options(), [](PtyTerminal& terminal, int) {
    return terminal.waitFor("NAIAD-HERE") && terminal.waitFor("\033[>31u");
  });
}

// The signals arrive while restore() runs.
TEST_F(TerminalSignalsTest, SignalsWhileLeavingRestoreTheTerminal) {
  endOften(options(), [](PtyTerminal& terminal, int attempt) {
    if (!terminal.waitFor("NAIAD-HERE")) return false;
    // Not Ctrl-C: if the modes are restored before the kernel handles it, the kernel discards the output.
    terminal.type("\x1dq");
    terminal.read(std::chrono::milliseconds(attempt % 3));
    return true;
  });
}

TEST_F(TerminalSignalsTest, SignalsWhileStartingRestoreTheTerminal) {
  endOften(options(), [](PtyTerminal& terminal, int) { return terminal.waitFor("\033[?1049h"); });
}

TEST_F(TerminalSignalsTest, SignalsInTheServerMenuRestoreTheTerminal) {
  PtyTerminal::Options chooser = options();
  chooser.command = {programPath("dfclient")};
  endOften(chooser, [](PtyTerminal& terminal, int attempt) {
    if (!terminal.waitFor("\033[?u")) return false;
    if (attempt % 2 == 0) terminal.type("q");  // restores the chooser's terminal while the signals arrive
    return true;
  });
}

// A common case: Ctrl-Z, then kill. The client ends and the shell keeps its terminal modes.
TEST_F(TerminalSignalsTest, KillAfterControlZRestoresTheTerminal) {
  for (const std::string kill : {"kill %1", "kill -HUP %1; kill %1; kill -INT %1",
                                 "bg >/dev/null; kill %1; kill %1", "bg >/dev/null; sleep .3; kill %1"}) {
    PtyTerminal terminal(shell());
    ASSERT_NO_FATAL_FAILURE(playAndSuspend(terminal));
    // `wait` does not wait for a stopped job.
    terminal.type(kill + R"sh(; while [ -n "$(jobs -p)" ]; do sleep .02; jobs; done; echo jobs-$((0)))sh"
                         "\n");
    ASSERT_TRUE(terminal.waitFor("jobs-0")) << kill << terminal.output();
    terminal.type("echo after-$(stty -g)-e''nd\n");
    ASSERT_TRUE(terminal.waitFor("-end\r\n")) << terminal.output();
    EXPECT_EQ(modesLeftOn(terminal.output()), "") << kill;
    const std::string all = terminal.output();
    std::smatch before;
    std::smatch after;
    ASSERT_TRUE(std::regex_search(all, before, std::regex("before-([0-9a-f:]+)\r")));
    ASSERT_TRUE(std::regex_search(all, after, std::regex("after-([0-9a-f:]+)-end\r")));
    EXPECT_EQ(before[1], after[1]) << kill;
    terminal.type("exit\n");
    EXPECT_NE(terminal.waitForExit(), -1);
  }
}

TEST_F(TerminalSignalsTest, ContinuedInBackgroundItDrawsOnlyInForeground) {
  PtyTerminal terminal(shell());
  ASSERT_NO_FATAL_FAILURE(playAndSuspend(terminal));
  terminal.forget();
  const std::size_t before = terminal.output().size();
  terminal.type("bg >/dev/null; sleep .5; jobs; echo d''one\n");
  ASSERT_TRUE(terminal.waitFor("done\r\n")) << terminal.output();
  EXPECT_EQ(terminal.output().find("NAIAD-HERE", before), std::string::npos)
      << "it draws on the shell's screen";
  EXPECT_TRUE(has(terminal.output(), "Running"));
  terminal.type("fg\n");
  EXPECT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
}

/// True if this session has a dfclient that is not a zombie.
bool clientRuns(pid_t session) {
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(process.path() / "stat");
    std::string stat;
    std::getline(file, stat);  // empty if it is not a process
    const std::size_t name = stat.find("(dfclient) ");
    if (name == std::string::npos) continue;
    char state = 'Z';
    pid_t its_session = 0;
    if (sscanf(&stat[name], "(dfclient) %c %*d %*d %d", &state, &its_session) == 2 &&
        its_session == session && state != 'Z')
      return true;
  }
  return false;
}

/// A way to start the client.
struct Launch {
  bool shell_leads;     ///< the shell is the session leader, so the session loses its terminal with it
  std::string wrapper;  ///< command that the shell runs to start the client; empty: none
};

class ShellEndTest : public TerminalSignalsTest, public testing::WithParamInterface<Launch> {};

TEST_P(ShellEndTest, EndsTheClientInTheBackground) {
  PtyTerminal::Options options = shell();
  options.leads = GetParam().shell_leads;
  PtyTerminal terminal(options);
  ASSERT_NO_FATAL_FAILURE(playAndSuspend(terminal, GetParam().wrapper));
  const pid_t session = getsid(terminal.pid());
  terminal.type("bg >/dev/null; echo d''one\n");
  ASSERT_TRUE(terminal.waitFor("done\r\n")) << terminal.output();
  ASSERT_TRUE(clientRuns(session));
  terminal.forget();
  terminal.type("exit\n");
  EXPECT_NE(terminal.waitForExit(), -1);
  EXPECT_TRUE(terminal.waitUntil([session] { return !clientRuns(session); }));
  EXPECT_FALSE(has(terminal.newOutput(), "NAIAD-HERE")) << "it draws for nobody";
}

INSTANTIATE_TEST_SUITE_P(Shells, ShellEndTest,
                         testing::Values(Launch{false, ""}, Launch{false, "sh -c"}, Launch{true, ""},
                                         Launch{true, "sh -c"}));

}  // namespace
}  // namespace naiad::test
