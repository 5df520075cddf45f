// The program dfreplay --until T --debug: a debugger gets the round's world before tick T. A small script
// replaces gdb.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/replay/FrailRound.h"
#include "tests/support/RunProgram.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

/// Returns the rest of the line after the last `mark` in `text`; "" if not found.
std::string restAfter(const std::string& text, const std::string& mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + mark.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

class DebugTest : public FrailRound {
 protected:
  /// Plays a round in which the key Q crashes the world twice, in two different ticks, and makes a debugger.
  void playToTheLastDeath(const std::string& debuggers_last_line = "exit 0") {
    makeDebugger(debuggers_last_line);
    play(50);
    press(df::Keyboard::Q);
    ASSERT_TRUE(tick()) << log;
    play(5);
    press(df::Keyboard::Q);
    ASSERT_FALSE(tick()) << log;
    file = endRound();
  }
  /// Returns the tick in the file in which Q was pressed for the first or the last time.
  int deathTick(bool last) const {
    std::ostringstream out;
    printInputs(RecordedRound(file), out);
    const std::string text = out.str();
    const std::size_t q = last ? text.rfind("key=Q") : text.find("key=Q");
    return std::atoi(text.c_str() + text.rfind("tick=", q) + 5);
  }
  /// Makes a script named gdb that records its arguments and the world's state, and makes the world continue.
  void makeDebugger(const std::string& last_line) const {
    const fs::path script = recorder.folder() / "bin" / "gdb";
    fs::create_directory(script.parent_path());
    std::ofstream(script) << "#!/bin/sh\n"
                          << "exec >>" << recorder.folder().string() << "/gdb.txt\n"
                          << "echo \"called: $*\"\n"
                          << "grep State: /proc/$3/status\n"
                          << "kill -CONT $3\n"
                          << "while grep -qv 'State:.*Z' /proc/$3/status 2>/dev/null; do\n"
                          << "  grep -q 'State:.Z' /proc/$3/status && break; sleep 0.01; done\n"
                          << last_line << "\n";
    fs::permissions(script, fs::perms::owner_all);
  }
  /// Runs a shell command. Its PATH has dfreplay and the script gdb, if that was made.
  std::pair<int, std::string> runLine(const std::string& line) const {
    return test::runProgram("PATH=" + (recorder.folder() / "bin").string() +
                            ":" NAIAD_BINARY_DIR ":/bin:/usr/bin " + line + " 2>&1 </dev/null");
  }
  std::string command(int tick) const {
    return "dfreplay " + file.string() + " --until " + std::to_string(tick) + " --debug --game " + module;
  }
  /// Debugs the round before `tick`. Expects this exit code and these texts.
  void expectRun(int tick, int code, const std::vector<std::string>& texts) const {
    const auto [status, said] = runLine(command(tick));
    EXPECT_EQ(status, code) << said;
    for (const std::string& text : texts) EXPECT_TRUE(test::has(said, text));
  }
  std::string called() const { return test::contentOf(recorder.folder() / "gdb.txt"); }

  fs::path file;
};

TEST_F(DebugTest, LoggedCommandStopsTheGameBeforeTheCrash) {
  playToTheLastDeath();
  const std::string line = restAfter(log, "to see where: ");
  ASSERT_EQ(line, command(deathTick(true))) << log;
  const auto [code, said] = runLine(line);
  EXPECT_EQ(code, 0) << said;
  const std::string process = restAfter(said, "The world is process ");
  EXPECT_TRUE(test::has(process, ", before tick " + std::to_string(deathTick(true)) + " of the round"))
      << said;
  const std::string number = process.substr(0, process.find(','));
  EXPECT_EQ(called().find("called: -q -p " + number + " -ex handle SIGSTOP nostop noprint nopass\nState:\tT"),
            0u)
      << called();
  const std::string end =
      "The world ended in tick " + std::to_string(deathTick(true)) + (test::kSanitized ? "" : ": SIGSEGV.");
  EXPECT_TRUE(test::has(said, end));
}

TEST_F(DebugTest, WorldPlaysFromTheChosenTickToItsCrash) {
  playToTheLastDeath();
  const int skipped = deathTick(false), last = deathTick(true);  // a recovery skipped the first crash
  ASSERT_LT(skipped, last);
  const std::string end = "The world ended in tick ";
  expectRun(skipped, 0, {end + std::to_string(skipped)});
  expectRun(20, 0, {"before tick 20 of the round", end + std::to_string(last)});
  expectRun(5000, 3, {"in tick " + std::to_string(last) + ", before tick 5000"});
}

TEST_F(DebugTest, ADebuggerThatFailsIsAnError) {
  playToTheLastDeath("exit 7");
  expectRun(20, 3, {"gdb exited with code 7"});
}

TEST_F(DebugTest, MissingDebuggerPrintsTheCommandToType) {
  playToTheLastDeath();
  // This PATH hides an installed gdb.
  const std::string line = "PATH=/nowhere " NAIAD_BINARY_DIR "/" + command(deathTick(true)) + " 2>&1";
  FILE* p_out = popen(line.c_str(), "re");
  ASSERT_NE(p_out, nullptr);
  std::string said;
  char row[512];
  while (fgets(row, sizeof row, p_out) != nullptr) {
    said += row;
    const std::string process = restAfter(row, "gdb is not installed. In another terminal: gdb -p ");
    if (!process.empty()) kill(std::atoi(process.c_str()), SIGCONT);
  }
  EXPECT_EQ(pclose(p_out), 0) << said;
  EXPECT_TRUE(test::has(said, "gdb -p "));
  EXPECT_TRUE(test::has(said, "The world ended in tick " + std::to_string(deathTick(true))));
}

TEST_F(DebugTest, DebugAndUntilRequireEachOther) {
  for (const char* p_one : {"--debug", "--until 5"}) {
    const auto [code, said] = runLine(std::string("dfreplay FILE ") + p_one);
    EXPECT_EQ(code, 2) << said;
    EXPECT_TRUE(test::has(said, "--debug and --until TICK require each other"));
  }
}

TEST(DebugCommandTest, NamesAnUninstalledGameAndQuotesPaths) {
  const std::string installed = GameModule::find("hello").string();
  EXPECT_EQ(debugCommand("/r/hello-1.dfr", 7, "hello", installed),
            "dfreplay /r/hello-1.dfr --until 7 --debug");
  EXPECT_EQ(debugCommand("/r/my game-1.dfr", 7, "my game", "/home/ann's/my game.so"),
            "dfreplay '/r/my game-1.dfr' --until 7 --debug --game '/home/ann'\\''s/my game.so'");
}

}  // namespace
}  // namespace naiad
