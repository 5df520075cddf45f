#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/world/TickStallMeter.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Doing = ProcessRunState::Doing;

/// Measures, every 100 ms, a process that computes for `share` percent of the time.
class TickStallMeterTest : public testing::Test {
 protected:
  TickStallMeter::Nanos run(std::chrono::milliseconds time, Doing doing, int share) {
    for (auto passed = 0ms; passed < time; passed += 100ms) {
      cpu += 100ms * share / 100;
      effort.add(100ms, [&] { return std::optional(ProcessRunState{doing, cpu}); });
    }
    return effort.counted();
  }
  TickStallMeter effort;
  std::chrono::nanoseconds cpu = 5h;  // processor time of earlier ticks
};

TEST_F(TickStallMeterTest, AnEndlessLoopCountsInFull) {
  EXPECT_GE(run(1000ms, Doing::kRuns, 100), 900ms) << "of the first look there is nothing to compare";
  EXPECT_LE(effort.counted(), 1000ms);
}

TEST_F(TickStallMeterTest, WaitingForSomethingCountsInFull) {
  EXPECT_EQ(run(1000ms, Doing::kWaits, 0), 1000ms);
}

TEST_F(TickStallMeterTest, AMachineUnderLoadGivesAGameMoreTime) {
  EXPECT_LT(run(3000ms, Doing::kRuns, 20), 1000ms);
  EXPECT_GT(run(57'000ms, Doing::kRuns, 0), 5s) << "but not for ever";
}

TEST_F(TickStallMeterTest, StoppedGameIsNotWaitedForForever) {
  EXPECT_LT(run(5s, Doing::kStopped, 0), 1s);
  EXPECT_GT(run(55s, Doing::kStopped, 0), 5s);
}

TEST_F(TickStallMeterTest, AGameInADebuggerIsWaitedFor) {
  run(300ms, Doing::kRuns, 100);
  const auto before = effort.counted();
  EXPECT_EQ(run(3600s, Doing::kDebugged, 0), before);
  EXPECT_EQ(effort.stopped(), 3600s);
  run(100ms, Doing::kRuns, 100);
  EXPECT_EQ(effort.stopped(), 0s) << "it goes on";
}

TEST_F(TickStallMeterTest, OwnTimeExcludesDelaysOfTheMachine) {
  run(1000ms, Doing::kWaits, 0);
  EXPECT_EQ(effort.own(), 1000ms);
  run(1000ms, Doing::kRuns, 20);
  EXPECT_EQ(effort.own(), 1200ms) << "what it computes";
  const auto before = effort.counted();
  run(60s, Doing::kRuns, 0);
  run(60s, Doing::kStopped, 0);
  run(60s, Doing::kDebugged, 0);
  EXPECT_EQ(effort.own(), 1200ms);
  EXPECT_GT(effort.counted(), before);
}

TEST_F(TickStallMeterTest, AllTimeCountsWithoutKernelInformation) {
  for (int i = 0; i < 10; ++i) effort.add(100ms, [] { return std::optional<ProcessRunState>(); });
  EXPECT_EQ(effort.counted(), 1000ms);
}

TEST_F(TickStallMeterTest, ShortTicksAreNotLookedInto) {
  bool looked = false;
  for (int i = 0; i < 3; ++i) {
    effort.add(16ms, [&looked] {
      looked = true;
      return std::optional<ProcessRunState>();
    });
  }
  EXPECT_FALSE(looked);
}

/// A child process that calls `what` repeatedly until it is killed.
class Child {
 public:
  template <class Do>
  explicit Child(Do what) : m_process(fork()) {
    if (m_process == 0) {
      for (;;) what();
    }
  }
  ~Child() {
    kill(m_process, SIGKILL);
    waitpid(m_process, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  pid_t process() const { return m_process; }
  bool comesTo(Doing doing, std::chrono::seconds patience = 60s) const {
    const auto end = std::chrono::steady_clock::now() + patience;
    do {
      if (const auto look = readProcessRunState(m_process); look && look->doing == doing) return true;
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }

 private:
  pid_t m_process;
};

TEST(LookAtProcess, SaysWhetherItRunsWaitsOrIsStopped) {
  const Child waits([] { pause(); });
  EXPECT_TRUE(waits.comesTo(Doing::kWaits));
  const Child runs([] {});
  EXPECT_TRUE(runs.comesTo(Doing::kRuns));
  kill(runs.process(), SIGSTOP);
  EXPECT_TRUE(runs.comesTo(Doing::kStopped));
  const auto before = readProcessRunState(runs.process());
  EXPECT_FALSE(runs.comesTo(Doing::kDebugged, 0s));
  kill(runs.process(), SIGCONT);
  EXPECT_TRUE(runs.comesTo(Doing::kRuns));
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (readProcessRunState(runs.process())->cpu <= before->cpu)
    ASSERT_LT(std::chrono::steady_clock::now(), end);
}

TEST(LookAtProcess, RecognizesADebuggedProcess) {
  const Child debugged([] {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGUSR1);
  });
  EXPECT_TRUE(debugged.comesTo(Doing::kDebugged));
}

TEST(LookAtProcess, ReturnsNothingForInvalidProcessIds) {
  EXPECT_FALSE(readProcessRunState(0));
  EXPECT_FALSE(readProcessRunState(-1));
}

TEST(SlowTickDetectorTest, OnlyComputingAndWaitingAreTheGamesOwn) {
  constexpr auto kFrame = 33ms;
  const std::string handler = ", while Ship handles EventStep";
  const Child child([] { pause(); });
  ASSERT_TRUE(child.comesTo(Doing::kWaits));
  const pid_t waiting = child.process();
  SlowTickDetector detector;
  detector.beginTick(waiting);
  EXPECT_EQ(detector.check(waiting, 7, 32ms, kFrame, handler), "");
  EXPECT_EQ(detector.check(waiting, 7, 40ms, kFrame, ""), "") << "no handler runs";
  EXPECT_EQ(detector.check(waiting, 1, 40ms, kFrame, handler), "") << "the first tick may load files";
  EXPECT_EQ(detector.check(waiting, 7, 40ms, kFrame, handler),
            "tick 7 takes longer than the frame time of 33 ms, while Ship handles EventStep: the game is not "
            "smooth "
            "(reported once)");
  EXPECT_EQ(detector.check(waiting, 8, 40ms, kFrame, handler), "") << "once";

  SlowTickDetector computing;
  computing.beginTick(getpid());
  EXPECT_EQ(computing.check(getpid(), 7, 1h, kFrame * 1000, handler), "") << "it waited for a processor";
  const auto begun = readProcessRunState(getpid())->cpu;
  while (readProcessRunState(getpid())->cpu - begun < kFrame) {
  }
  EXPECT_NE(computing.check(getpid(), 7, 40ms, kFrame, handler), "");
}

}  // namespace
}  // namespace naiad
