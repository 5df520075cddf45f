// The host's end of a world's process. /bin/sh plays the world; it uses descriptor 3.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/world/ActivityReader.h"
#include "host/world/OutputRelay.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldProcess.h"

namespace naiad {
namespace {

std::string escape(const std::string& frame) {
  std::string escaped;
  for (const char byte : frame) {
    char octal[5];
    std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned char>(byte));
    escaped += octal;
  }
  return escaped;
}

std::string readyFrame() {
  std::string frame;
  writeReady({}, frame);
  return frame;
}

constexpr std::size_t kFirstDigit = kWorldFrameHead + 1;  ///< position of the build id in that frame

class WorldProcessTest : public testing::Test {
 protected:
  static WorldProgram shell(const std::string& script) {
    WorldProgram program{"/bin/sh", {"sh", "-c", script}, {"PATH=/usr/bin:/bin"}, "/", {}};
    program.sandbox.on = false;
    return program;
  }
  /// Runs the program until it ends, with up to `ahead` turns in advance. Returns how it ended.
  WorldEnd play(const std::string& script) { return play(shell(script)); }
  WorldEnd play(const WorldProgram& program) {
    const WorldLauncher launcher(program);
    WorldProcess world(m_io, launcher.start(), [this](const std::string& line) { printed.push_back(line); });
    world.setOnTick([this] { ++ticks; });
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!world.end() && std::chrono::steady_clock::now() < end) {
      m_io.restart();
      m_io.run_one_for(std::chrono::milliseconds(5));
      world.checkProcess(1);
      if (auto warning = world.popWarning()) warnings.push_back(*std::move(warning));
      for (int i = 0; i < ahead && (i > 0 || world.isReady()); ++i) world.tick({WorldTurn(), "abc"});
    }
    return world.end().value_or(WorldEnd{WorldEnd::kHung, "is still there", 0, {}, {}});
  }

  /// Script: reports readiness. takesTurn() reads a turn of 4 + 1 + 3 bytes.
  static std::string isReady() { return "printf '" + escape(readyFrame()) + "' >&3; "; }
  /// Script: answers with nothing but, if `is_over`, that the game is over.
  static std::string answers(bool is_over = false) {
    WorldAnswer answer;
    answer.game_over = is_over;
    ViewWriter views;
    std::string frame;
    writeAnswer(answer, nullptr, views, frame);
    return "printf '" + escape(frame) + "' >&3; ";
  }
  static std::string takesTurn() { return "dd bs=8 count=1 <&3 2>/dev/null >/dev/null; "; }

  int ahead = 1;
  int ticks = 0;
  std::vector<std::string> printed;
  std::vector<std::string> warnings;

 private:
  asio::io_context m_io;
};

TEST_F(WorldProcessTest, FailedExitOrSignalIsACrash) {
  EXPECT_EQ(play("exit 0").why, WorldEnd::kGameOver);
  EXPECT_EQ(play("exit 3").text, "ended with code 3");
  EXPECT_EQ(play("kill -SEGV $$").text, "crashed (SIGSEGV)");
}

TEST_F(WorldProcessTest, ACrashSaysInWhichTickItWas) {
  const std::string answer = answers();
  const std::string crash = "kill -SEGV $$";
  EXPECT_EQ(play(crash).when, "");
  EXPECT_EQ(play(isReady() + takesTurn() + answer + takesTurn() + crash).when, "in tick 2");
  EXPECT_EQ(play(isReady() + takesTurn() + answer + "exit 0").when, "");
  EXPECT_EQ(play(isReady() + takesTurn() + answers(true) + crash).when, "after tick 1");
}

TEST_F(WorldProcessTest, CrashIsReportedForFirstUnansweredTurn) {
  ahead = 3;
  const std::string turn = takesTurn() + answers();
  EXPECT_EQ(play(isReady() + turn + turn + turn + takesTurn() + "kill -SEGV $$").when, "in tick 4");
  EXPECT_EQ(ticks, 3);
  EXPECT_EQ(play(isReady() + turn + turn + "kill -SEGV $$").when, "in tick 3");
  EXPECT_EQ(ticks, 5);
  EXPECT_EQ(play(isReady() + turn + takesTurn() + takesTurn() + "kill -SEGV $$").when, "in tick 2");
}

TEST_F(WorldProcessTest, GarbageActivityPageIsReadAsPrintableText) {
  // Zeros are replaced, because a line that begins with one is empty.
  const std::string garbage =
      "head -c " + std::to_string(sizeof(df::ActivityPage)) + " /dev/urandom | tr '\\000' x >&4; ";
  const WorldEnd end = play(isReady() + takesTurn() + garbage + "kill -SEGV $$");
  EXPECT_EQ(end.when.rfind("in tick 1, while an Object of unknown class handled an event", 0), 0u)
      << end.when;
  EXPECT_EQ(end.last_lines.size(), df::ActivityPage::kLines);
  for (const std::string& line : end.last_lines) {
    EXPECT_LE(line.size(), 512u);
    for (const char c : line) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << line;
  }
}

TEST_F(WorldProcessTest, ActivityPageCannotBeTruncated) {
  // If it could, reading beyond the new end would raise SIGBUS.
  const WorldEnd end = play(isReady() + takesTurn() + "truncate -s 0 /proc/self/fd/4 2>&1; kill -SEGV $$");
  EXPECT_EQ(end.when, "in tick 1");
  EXPECT_FALSE(printed.empty()) << "the attempt fails";
}

TEST_F(WorldProcessTest, WorldSendingAMalformedFrameIsKilled) {
  // A frame of four gigabytes, two malformed ready frames, an answer without a turn, and a malformed answer.
  for (const char* p_sent :
       {"\\377\\377\\377\\377", "\\1\\0\\0\\0x", "\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0"}) {
    EXPECT_EQ(play("printf '" + std::string(p_sent) + "' >&3; exec sleep 100").why, WorldEnd::kBroken)
        << p_sent;
  }
  EXPECT_EQ(play("printf '\\0\\0\\0\\0' >&3; dd bs=8 count=1 <&3 2>/dev/null >/dev/null; printf "
                 "'\\2\\0\\0\\0\\7\\7' >&3; exec sleep 100")
                .why,
            WorldEnd::kBroken);
  EXPECT_EQ(ticks, 0);
}

TEST_F(WorldProcessTest, WorldOfAnotherBuildIsEnded) {
  std::string frame = readyFrame();
  frame[kFirstDigit] = frame[kFirstDigit] == 'a' ? 'b' : 'a';
  const std::string id = frame.substr(kFirstDigit, 8);
  for (const bool knows_our_fields : {true, false}) {
    if (!knows_our_fields) frame.back() = '\xff';
    const WorldEnd end = play("printf '" + escape(frame) + "' >&3; exec sleep 100");
    EXPECT_EQ(end.why, WorldEnd::kForeign);
    EXPECT_EQ(end.text, "has another build (" + id + ")");
  }
  EXPECT_EQ(ticks, 0);
}

TEST_F(WorldProcessTest, WorldThatClosesItsSocketIsKilled) {
  EXPECT_EQ(play("exec 3>&-; exec sleep 100").why, WorldEnd::kCrashed);
}

// The host needs the process id to watch and copy the process.
TEST_F(WorldProcessTest, IsReadyOnceTheSupervisorReportsItsProcessId) {
  int world_ends[2];
  int supervisor_ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, world_ends), 0);
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, supervisor_ends), 0);
  asio::io_context io;
  StartedWorld started;
  started.socket = world_ends[0];
  started.supervisor = supervisor_ends[0];
  WorldProcess world(io, started);
  const auto look = [&] {
    io.restart();
    io.run_for(std::chrono::milliseconds(5));
    world.checkProcess(1);
    return world.isReady();
  };
  const std::string frame = readyFrame();
  ASSERT_EQ(write(world_ends[1], frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(look());
  const WorldStartReport start{0, getpid()};
  ASSERT_EQ(write(supervisor_ends[1], &start, sizeof start), static_cast<ssize_t>(sizeof start));
  bool ready = false;
  for (int i = 0; i < 1000 && !ready; ++i) ready = look();
  EXPECT_TRUE(ready);
  const WorldExitReport end;  // sent by the supervisor when all have ended
  EXPECT_EQ(write(supervisor_ends[1], &end, sizeof end), static_cast<ssize_t>(sizeof end));
  close(world_ends[1]);
  close(supervisor_ends[1]);
}

TEST_F(WorldProcessTest, AProgramThatIsNotThereIsAnError) {
  for (const bool sandbox : {false, true}) {
    WorldProgram program{"/nonexistent/game", {"game"}, {}, "/", {}};
    program.sandbox.on = sandbox;
    const WorldEnd end = play(program);
    EXPECT_EQ(end.why, WorldEnd::kCrashed);
    EXPECT_EQ(end.text, "could not be started: No such file or directory");
  }
}

TEST_F(WorldProcessTest, OutputIsRelayedToTheLastLine) {
  EXPECT_EQ(play("echo one; echo two >&2; printf three; kill -SEGV $$").text, "crashed (SIGSEGV)");
  EXPECT_EQ(printed, (std::vector<std::string>{"one", "two", "three"}));
}

TEST_F(WorldProcessTest, OutputFloodIsLimitedAndTheExitReported) {
  EXPECT_EQ(play("head -c 2000000 /dev/zero | tr '\\0' '\\n'; echo end; exit 3").text, "ended with code 3");
  EXPECT_LT(printed.size(), 20'000u);
  EXPECT_NE(std::ranges::find_if(
                printed, [](const std::string& line) { return line.ends_with("(too many at once)"); }),
            printed.end());
}

class HangingWorldTest : public WorldProcessTest {
 protected:
  static constexpr std::chrono::milliseconds kHangTime{150};
  /// A program that answers one turn and runs `how` in the next.
  static WorldProgram hangs(const std::string& how) {
    WorldProgram program = shell(isReady() + takesTurn() + answers() + takesTurn() + how);
    program.hang_time = kHangTime;
    return program;
  }
  /// Returns the warnings about tick 2. On a loaded machine, tick 1 may cause one as well.
  std::vector<std::string> warningsOfHang() const {
    std::vector<std::string> of_hang;
    std::ranges::copy_if(warnings, std::back_inserter(of_hang),
                         [](const std::string& text) { return text.find("tick 2") != std::string::npos; });
    return of_hang;
  }
};

TEST_F(HangingWorldTest, EndlessLoopIsReportedAndThenEnded) {
  const auto began = std::chrono::steady_clock::now();
  const WorldEnd end = play(hangs("while :; do :; done"));
  EXPECT_GE(std::chrono::steady_clock::now() - began, kHangTime * (WorldProcess::kAnswerTimeoutFactor - 1));
  EXPECT_EQ(end.why, WorldEnd::kHung);
  EXPECT_EQ(warningsOfHang(),
            (std::vector<std::string>{
                "the game has not finished tick 2 for 0.15 s: it hangs, and all players wait"}));
}

TEST_F(HangingWorldTest, EndlessWaitIsReportedAndThenEnded) {
  EXPECT_EQ(play(hangs("exec sleep 100")).why, WorldEnd::kHung);
  EXPECT_EQ(warningsOfHang().size(), 1u);
}

TEST_F(HangingWorldTest, SlowTickIsReportedAndMayFinish) {
  const WorldEnd end = play(hangs("sleep 0.3; " + answers() + "exit 0"));
  EXPECT_EQ(end.why, WorldEnd::kGameOver);
  EXPECT_EQ(ticks, 2);
  EXPECT_EQ(warningsOfHang().size(), 1u);
}

TEST_F(HangingWorldTest, TheFirstTickMayTakeLong) {
  WorldProgram program = shell(isReady() + takesTurn() + "sleep 1; " + answers() + "exit 0");
  program.hang_time = kHangTime;
  EXPECT_EQ(play(program).why, WorldEnd::kGameOver);
  EXPECT_EQ(ticks, 1);
}

/// The game is stopped for longer than a hanging world would survive.
TEST_F(HangingWorldTest, StoppedGameIsReportedAndGetsMoreTime) {
  const std::string goes_on = "(sleep 1.2; kill -CONT $$) & ";
  const WorldEnd end = play(hangs(goes_on + "kill -STOP $$; " + answers() + "exit 0"));
  EXPECT_EQ(end.why, WorldEnd::kGameOver);
  EXPECT_EQ(ticks, 2);
  ASSERT_FALSE(warningsOfHang().empty());
  EXPECT_EQ(warningsOfHang().front(),
            "the game is stopped in tick 2, by a debugger or a signal, and all players wait");
}

std::string classOfName(const char* p_mangled) {
  return std::string(classInMangled(p_mangled));
}

TEST(ActivityReader, ExtractsTheClassFromAMangledName) {
  EXPECT_EQ(classOfName("9EventStep"), "EventStep");
  EXPECT_EQ(classOfName("N2df9EventStepE"), "EventStep");
  EXPECT_EQ(classOfName("N12_GLOBAL__N_14ShipE"), "Ship");
  EXPECT_EQ(classOfName("*N12_GLOBAL__N_14ShipE"), "Ship");
  EXPECT_EQ(classOfName("12PlayerObjectIN2df6ObjectEE"), "PlayerObject");
  EXPECT_EQ(classOfName("Z4mainE4Ship"), "Ship");
  for (const char* p_strange : {"", "N", "Z", "99x", "4Sh", "St9exception", "99999999999999999999999x"})
    EXPECT_EQ(classOfName(p_strange), p_strange);
}

TEST(ActivityReader, DescribesTheRunningHandler) {
  const auto page = std::make_unique<df::ActivityPage>();
  EXPECT_TRUE(describeActivity(*page, "handled").empty());
  page->addName(16, "4Ship");
  page->addName(24, "N2df9EventStepE");
  page->now.object_class = 16;
  page->now.event_class = 24;
  EXPECT_EQ(describeActivity(*page, "handles").view(), ", while Ship handles EventStep");
  page->now.event_class = df::Activity::kDraw;
  EXPECT_EQ(describeActivity(*page, "handled").view(), ", while Ship ran draw()");
  page->now.object_class = 4711;
  page->now.event_class = 4712;
  EXPECT_EQ(describeActivity(*page, "handled").view(), ", while an Object of unknown class handled an event");
}

TEST(ActivityReader, FullNameTableKeepsItsClasses) {
  const auto page = std::make_unique<df::ActivityPage>();
  for (std::uintptr_t id = 1; id <= df::ActivityPage::kNames + 10; ++id)
    page->addName(8 * id, ("5C" + std::to_string(1000 + id)).c_str());
  page->now.event_class = df::Activity::kDraw;
  for (std::uintptr_t id = 1; id <= df::ActivityPage::kNames; ++id) {
    page->now.object_class = 8 * id;
    EXPECT_EQ(describeActivity(*page, "").view(), ", while C" + std::to_string(1000 + id) + " ran draw()");
  }
}

TEST(ActivityReader, KeepsTheLastLinesEscapedAndCapped) {
  const auto page = std::make_unique<df::ActivityPage>();
  EXPECT_TRUE(logLine(*page, 0).empty());
  for (int i = 0; i < 20; ++i) page->addLine("line " + std::to_string(i));
  EXPECT_EQ(logLine(*page, 0).view(), "line 19");
  EXPECT_EQ(logLine(*page, df::ActivityPage::kLines - 1).view(), "line 12");
  EXPECT_TRUE(logLine(*page, df::ActivityPage::kLines).empty());
  page->addLine("\033[2J\n\xc3\xa9");
  EXPECT_EQ(logLine(*page, 0).view(), "\\x1b[2J\\x0a\\xc3\\xa9");
  page->addLine(std::string(1000, 'x'));
  EXPECT_EQ(logLine(*page, 0).view(), std::string(160, 'x'));
  page->addLine(std::string(1000, '\x01'));
  EXPECT_EQ(logLine(*page, 0).view().size(), 512u);
}

class OutputRelayTest : public testing::Test {
 protected:
  OutputRelayTest() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
    m_end = ends[1];
    relay.emplace(ends[0], [this](const std::string& line) { lines.push_back(line); });
  }
  ~OutputRelayTest() override { close(m_end); }
  /// Writes to the pipe. False once it is full.
  bool print(const std::string& text) const {
    return write(m_end, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  }

  std::vector<std::string> lines;
  std::optional<OutputRelay> relay;
  OutputRelay::Clock::time_point now = OutputRelay::Clock::now();

 private:
  int m_end = -1;
};

TEST_F(OutputRelayTest, RelaysCompleteLinesAndTheRestAtTheEnd) {
  print("one\ntw");
  relay->update(now);
  EXPECT_EQ(lines, std::vector<std::string>{"one"});
  print("o\n\nthree");
  relay->update(now);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", ""}));
  relay->finish(now);
  EXPECT_EQ(lines.back(), "three");
}

TEST_F(OutputRelayTest, LongLinesAreCut) {
  for (int i = 0; i < 4; ++i) print(std::string(OutputRelay::kMaxLine, 'x'));
  print("\nshort\n");
  relay->update(now);
  EXPECT_EQ(lines, (std::vector<std::string>{std::string(OutputRelay::kMaxLine, 'x'), "short"}));
}

TEST_F(OutputRelayTest, AFloodIsReadInPiecesLimitedAndCounted) {
  constexpr std::size_t kBurst = static_cast<std::size_t>(OutputRelay::kRate.burst);
  std::size_t printed = 0;
  for (int tick = 0; tick < 20; ++tick) {
    while (print("flood!\n")) ++printed;
    relay->update(now);
    EXPECT_TRUE(print("flood!\n")) << "the world goes on";
    ++printed;
  }
  relay->update(now);
  EXPECT_EQ(lines.size(), kBurst);
  now += std::chrono::seconds(1);
  print("later\n");
  relay->update(now);
  ASSERT_EQ(lines.size(), kBurst + 2);
  EXPECT_EQ(lines[kBurst], std::to_string(printed - kBurst) + " lines dropped (too many at once)");
  EXPECT_EQ(lines.back(), "later");
}

TEST_F(OutputRelayTest, OneUpdateReadsNoMoreThanItsShare) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
  if (fcntl(ends[0], F_SETPIPE_SZ, 4 * OutputRelay::kMaxRead) < 0) {
    close(ends[0]);
    close(ends[1]);
    GTEST_SKIP() << "no pipe may be that large";
  }
  OutputRelay large(ends[0], {});
  const std::string all(4 * OutputRelay::kMaxRead, 'x');
  EXPECT_EQ(write(ends[1], all.data(), all.size()), static_cast<ssize_t>(all.size()));
  large.update(now);
  EXPECT_LE(write(ends[1], all.data(), all.size()), static_cast<ssize_t>(OutputRelay::kMaxRead));
  close(ends[1]);
}

}  // namespace
}  // namespace naiad
