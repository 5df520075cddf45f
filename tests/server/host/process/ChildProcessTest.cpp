#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "host/process/ChildProcess.h"
#include "tests/support/Processes.h"

namespace naiad {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLong{60};
constexpr std::chrono::milliseconds kShort{200};

ChildExit runShell(const std::string& script, std::chrono::milliseconds limit = kLong) {
  return ChildProcess().run("/bin/sh", {"-c", script}, limit);
}

TEST(ChildProcess, SaysWhatItPrintedAndItsCode) {
  const ChildExit end = runShell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(end.code, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(end.timed_out);
  EXPECT_EQ(end.output_text, "out\nerr\n");
}

TEST(ChildProcess, SaysWhichSignalEndedIt) {
  const ChildExit end = runShell("kill -9 $$");
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_FALSE(end.timed_out);
}

TEST(ChildProcess, SaysThatItCannotBeStarted) {
  EXPECT_EQ(ChildProcess().run("/nowhere/dfreplay", {}, kLong).code, ChildExit::kNotStarted);
}

TEST(ChildProcess, HangingProgramIsKilledWithItsChildren) {
  const auto began = Clock::now();
  const ChildExit end = runShell("sleep 300 & echo $!; trap '' TERM; wait", kShort);
  EXPECT_TRUE(end.timed_out);
  EXPECT_LT(Clock::now() - began, kLong);
  const pid_t other = std::stoi(end.output_text);
  // At most a zombie is left, until its new parent has waited for it.
  const auto isDead = [&] { return test::stateOf(other) == 'X' || test::stateOf(other) == 'Z'; };
  while (!isDead() && Clock::now() - began < kLong) std::this_thread::yield();
  EXPECT_TRUE(isDead());
}

TEST(ChildProcess, RunDoesNotWaitForLeftoverChildren) {
  const auto began = Clock::now();
  const ChildExit end = runShell("sleep 300 & echo $!");
  EXPECT_EQ(end.code, 0);
  EXPECT_LT(Clock::now() - began, kLong);
  kill(std::stoi(end.output_text), SIGKILL);
}

TEST(ChildProcess, EndlesslyPrintingProgramIsKilledAtTheTimeout) {
  const ChildExit end = runShell("yes", kShort);
  EXPECT_TRUE(end.timed_out);
  EXPECT_EQ(end.output_text.size(), ChildProcess::kMaxOutput);
}

TEST(ChildProcess, ProgramInheritsNoOpenFiles) {
  const int file = open("/dev/zero", O_RDONLY);  // without O_CLOEXEC
  ASSERT_GE(file, 0);
  const ChildExit end =
      runShell("test -e /proc/self/fd/" + std::to_string(file) + " && echo there || echo gone");
  close(file);
  EXPECT_EQ(end.output_text, "gone\n");
}

TEST(ChildProcess, CancelEndsTheRunAndPreventsLaterOnes) {
  ChildProcess run;
  ChildExit end;
  std::thread thread([&] { end = run.run("/bin/sh", {"-c", "echo x; exec sleep 300"}, kLong * 5); });
  const auto began = Clock::now();
  run.cancel();
  thread.join();
  EXPECT_LT(Clock::now() - began, kLong);
  EXPECT_TRUE(end.signal == SIGKILL || end.code == ChildExit::kNotStarted);
  EXPECT_EQ(run.run("/bin/sh", {"-c", "exit 0"}, kLong).code, ChildExit::kNotStarted) << "no other begins";
}

}  // namespace
}  // namespace naiad
