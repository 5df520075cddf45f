// The processes around a world; a shell plays the world.
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/world/Descendants.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldStart.h"
#include "tests/support/Processes.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

constexpr int kPatienceMillis = 30'000;

/// If this variable is set, the test program is a game that hops: each process starts another in a session of
/// its own and ends at once, so every list of processes is soon wrong.
constexpr const char* kHops = "NAIAD_TEST_HOPS";

int hop(void* /*nothing*/) {
  constexpr std::size_t kStack = std::size_t{16} << 10;
  alignas(16) static char stacks[64][kStack];  // shared by all processes, which makes starting them fast
  static const auto end =
      std::chrono::steady_clock::now() + std::chrono::seconds(60);  // limit in case the test does not end it
  static int hops = 0;
  setsid();
  if (++hops == 100 && write(kWorldSocket, "hops\n", 5) != 5) _exit(1);
  if (std::chrono::steady_clock::now() < end)
    clone(hop, stacks[hops % 64] + kStack, CLONE_VM | SIGCHLD, nullptr);
  _exit(0);
}

[[maybe_unused]] const bool g_hops = [] {
  if (std::getenv(kHops) == nullptr) return false;
  if (fork() == 0) hop(nullptr);
  pause();
  return true;
}();

WorldProgram shell(const std::string& script) {
  WorldProgram program{"/bin/sh", {"sh", "-c", script}, {"PATH=/usr/bin:/bin"}, "/", {}};
  program.sandbox.on = false;
  return program;
}

/// Reads the world's output on its socket up to a line feed or the end.
std::string readLine(int socket) {
  std::string line;
  pollfd readable{socket, POLLIN, 0};
  for (char byte = 0; poll(&readable, 1, kPatienceMillis) > 0 && recv(socket, &byte, 1, 0) == 1;) {
    if (byte == '\n') break;
    line += byte;
  }
  return line;
}

/// Waits for the world's process id; -1 if it was not started.
pid_t waitForStart(const StartedWorld& world) {
  pollfd readable{world.supervisor, POLLIN, 0};
  WorldStartReport begun;
  if (poll(&readable, 1, kPatienceMillis) <= 0) return -1;
  return recv(world.supervisor, &begun, sizeof begun, MSG_WAITALL) == sizeof begun && begun.error == 0
             ? begun.process
             : -1;
}

/// Waits for the supervisor's next report; nullopt after a timeout.
std::optional<WorldExitReport> waitForReport(const StartedWorld& world) {
  pollfd readable{world.supervisor, POLLIN, 0};
  WorldExitReport end;
  if (poll(&readable, 1, kPatienceMillis) <= 0) return std::nullopt;
  if (recv(world.supervisor, &end, sizeof end, MSG_WAITALL) != sizeof end) return std::nullopt;
  return end;
}

/// Waits until the world and its descendants have ended. Returns its status; nullopt after a timeout.
std::optional<int> waitForEnd(const StartedWorld& world) {
  const auto end = waitForReport(world);
  return end ? std::optional<int>(end->status) : std::nullopt;
}

void closeBoth(const StartedWorld& world) {
  close(world.socket);
  close(world.supervisor);
  close(world.output);
}

TEST(WorldLauncher, LeftoverProcessesEndBeforeTheEndIsReported) {
  const WorldLauncher launcher(shell("setsid sh -c 'echo $$ >&3; exec sleep 1000' & read word <&3; exit 0"));
  const StartedWorld world = launcher.start();
  const pid_t left = std::stoi(readLine(world.socket));
  EXPECT_EQ(kill(left, 0), 0);
  EXPECT_EQ(send(world.socket, "\n", 1, MSG_NOSIGNAL), 1);
  EXPECT_GT(waitForStart(world), 1);
  EXPECT_EQ(waitForEnd(world), 0);
  EXPECT_EQ(kill(left, 0), -1);
  closeBoth(world);
}

TEST(WorldLauncher, ClosingTheSupervisorSocketEndsTheWorld) {
  const WorldLauncher launcher(shell("(setsid sh -c 'echo $$ >&3; exec sleep 1000' &) ; exec sleep 1000"));
  const StartedWorld shut = launcher.start();
  const pid_t of_shut = std::stoi(readLine(shut.socket));
  const StartedWorld closed = launcher.start();
  const pid_t process = waitForStart(closed);
  ASSERT_GT(process, 1);
  const pid_t of_closed = std::stoi(readLine(closed.socket));

  shutdown(shut.supervisor, SHUT_WR);
  EXPECT_GT(waitForStart(shut), 1);
  EXPECT_EQ(waitForEnd(shut), SIGKILL);
  EXPECT_EQ(kill(of_shut, 0), -1);
  EXPECT_EQ(kill(of_closed, 0), 0) << "that of another world";
  closeBoth(closed);
  EXPECT_TRUE(test::isGone(of_closed));
  EXPECT_TRUE(test::isGone(process));
  closeBoth(shut);
}

TEST(WorldLauncher, KilledLauncherIsReplacedAndItsWorldsGoOn) {
  if (test::kThreadSanitized) GTEST_SKIP() << "its runtime gives what is forked a thread";
  const WorldLauncher launcher(shell("read word <&3; exit 7"));
  const StartedWorld before = launcher.start();
  EXPECT_GT(waitForStart(before), 1);
  const std::vector<pid_t> launchers = test::processesBelow(getpid(), "df-launcher");
  ASSERT_EQ(launchers.size(), 1u);
  kill(launchers.front(), SIGKILL);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatienceMillis);
  while (test::stateOf(launchers.front()) != 'Z' && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // until the next check
  const StartedWorld after = launcher.start();
  for (const StartedWorld& world : {after, before}) {
    if (world.socket == after.socket) {
      EXPECT_GT(waitForStart(world), 1);
    }
    EXPECT_EQ(send(world.socket, "end\n", 4, MSG_NOSIGNAL), 4);
    const auto status = waitForEnd(world);
    ASSERT_TRUE(status);
    EXPECT_TRUE(WIFEXITED(*status) && WEXITSTATUS(*status) == 7) << *status;
    closeBoth(world);
  }
}

TEST(WorldLauncher, EndlesslyForkingGameIsEnded) {
  // Each process leaves its group and starts two more, whose parents have then ended.
  const std::string script =
      "echo $1 >&3; test $1 -lt 7 && for i in 1 2; do setsid sh -c \"$0\" \"$0\" $(($1 + 1)) & done; exec "
      "sleep 1000";
  WorldProgram program = shell(script);
  program.arguments.insert(program.arguments.end(), {script, "0"});
  const WorldLauncher launcher(program);
  const StartedWorld world = launcher.start();
  while (readLine(world.socket) != "7") continue;  // at "7", most of the 255 processes have begun
  shutdown(world.supervisor, SHUT_WR);
  EXPECT_GT(waitForStart(world), 1);
  EXPECT_EQ(waitForEnd(world), SIGKILL);
  while (!readLine(world.socket).empty()) continue;
  char byte = 0;
  EXPECT_EQ(recv(world.socket, &byte, 1, MSG_DONTWAIT), 0) << "one of them has it open still";
  closeBoth(world);
}

TEST(WorldLauncher, GameHoppingBetweenProcessesIsEnded) {
  if (test::kThreadSanitized) GTEST_SKIP() << "this sanitizer takes processes that share memory for threads";
  WorldProgram program{"/proc/self/exe", {"game"}, {std::string(kHops) + "=1"}, "/", {}};
  for (const char* kept : {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "TSAN_OPTIONS"}) {
    if (const char* p_value = std::getenv(kept))
      program.environment.push_back(std::string(kept) + "=" + p_value);
  }
  program.sandbox.on = false;
  const WorldLauncher launcher(program);
  const StartedWorld world = launcher.start();
  EXPECT_EQ(readLine(world.socket), "hops");
  shutdown(world.supervisor, SHUT_WR);
  EXPECT_GT(waitForStart(world), 1);
  EXPECT_EQ(waitForEnd(world), SIGKILL);
  char byte = 0;
  EXPECT_EQ(recv(world.socket, &byte, 1, MSG_DONTWAIT), 0) << "one of them has it open still";
  closeBoth(world);
}

TEST(Descendants, ChildIsFoundAndEnded) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    setsid();
    close(ends[1]);
    char byte = 0;
    _exit(read(ends[0], &byte, 1) == 0 ? 0 : 1);
  }
  close(ends[0]);
  const std::vector<pid_t> found = findChildren();
  if (found.empty()) {
    close(ends[1]);
    waitpid(child, nullptr, 0);
    GTEST_SKIP() << "this kernel keeps no list of children";
  }
  EXPECT_EQ(found, std::vector<pid_t>{child});
  killChild(child);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(findChildren().empty());
  close(ends[1]);
}

TEST(Descendants, IncludeOnlyChildrenAndGrandchildren) {
  int ends[2];
  int names[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(pipe(names), 0);
  const pid_t child = fork();
  if (child == 0) {
    const pid_t grandchild = fork();
    close(ends[1]);
    char byte = 0;
    if (grandchild != 0 && write(names[1], &grandchild, sizeof grandchild) < 0) _exit(1);
    _exit(read(ends[0], &byte, 1) == 0 ? 0 : 1);
  }
  pid_t grandchild = 0;
  ASSERT_EQ(read(names[0], &grandchild, sizeof grandchild), static_cast<ssize_t>(sizeof grandchild));
  EXPECT_TRUE(isDescendant(child));
  EXPECT_TRUE(isDescendant(grandchild));
  for (const pid_t other : {getpid(), getppid(), pid_t(1), pid_t(0), pid_t(-1)})
    EXPECT_FALSE(isDescendant(other)) << other;
  for (const int end : {ends[0], ends[1], names[0], names[1]}) close(end);
  waitpid(child, nullptr, 0);
}

TEST(WorldLauncher, WorldHasItsOwnSessionAndOnlyItsDescriptors) {
  const WorldLauncher launcher(
      shell("read pid comm state ppid pgrp session tty rest < /proc/$$/stat; "
            "for n in 0 1 2 3 4 5 6 7 8 9 10 99 100 101; do test -e /proc/$$/fd/$n && set -- $* $n; done; "
            "echo $(($$ == pgrp)) $(($$ == session)) $tty, $*, $(readlink /proc/$$/fd/0) >&3"));
  for (const bool copies : {false, true}) {
    WorldStartOptions order;
    order.copies = copies;
    const StartedWorld world = launcher.start(order);
    EXPECT_EQ(world.copies >= 0, copies);
    EXPECT_EQ(readLine(world.socket),
              std::string("1 1 0, 0 1 2 3 4") + (copies ? " 100" : "") + ", /dev/null");
    EXPECT_GT(waitForStart(world), 1);
    EXPECT_EQ(waitForEnd(world), 0);
    closeBoth(world);
    if (world.copies >= 0) close(world.copies);
  }
}

TEST(KillOthers, ContinuesAfterAPauseOfTheMachine) {
  const pid_t other = fork();
  if (other == 0) {
    pause();
    _exit(0);
  }
  // When the other process has ended, this one pauses for longer than all searches would take.
  const auto before = signal(SIGCHLD, [](int) {
    const timespec pause{1, 0};
    nanosleep(&pause, nullptr);
  });
  EXPECT_TRUE(killOthers({}));
  signal(SIGCHLD, before);
  EXPECT_EQ(kill(other, 0), -1);
}

/// Tests with a world that ends and leaves three processes, which the supervisor takes for its copies.
class LeftCopies : public testing::Test {
 protected:
  LeftCopies() {
    WorldStartOptions order;
    order.copies = true;
    world = launcher.start(order);
    EXPECT_GT(waitForStart(world), 1);
    for (pid_t& one : left) one = std::stoi(readLine(world.socket));
    EXPECT_EQ(send(world.socket, "\n", 1, MSG_NOSIGNAL), 1);
    EXPECT_EQ(nextReport(), "exit 7, copies are there");
  }
  ~LeftCopies() override {
    closeBoth(world);
    close(world.copies);
  }
  std::string nextReport() const {
    constexpr const char* kKinds[] = {", all have ended", ", copies are there", ", resumed"};
    const auto end = waitForReport(world);
    if (!end) return "nothing";
    return (WIFEXITED(end->status) ? "exit " + std::to_string(WEXITSTATUS(end->status))
                                   : "signal " + std::to_string(WTERMSIG(end->status))) +
           kKinds[end->kind];
  }
  void order(const SupervisorCommand& order) const {
    EXPECT_EQ(send(world.supervisor, &order, sizeof order, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof order));
  }

  const WorldLauncher launcher{
      shell("for i in 1 2 3; do sleep 1000 & echo $! >&3; done; read word <&3; exit 7")};
  StartedWorld world;
  pid_t left[3] = {};
};

TEST_F(LeftCopies, ChosenCheckpointResumesAndUnlistedOnesEnd) {
  order({SupervisorCommand::kResume, left[0], {left[1], 0, 0}});
  EXPECT_EQ(nextReport(), "exit 7, resumed");
  EXPECT_EQ(kill(left[2], 0), -1);
  EXPECT_EQ(kill(left[0], 0), 0);
  EXPECT_EQ(kill(left[1], 0), 0);
  order({SupervisorCommand::kEndWorld, 0, {}});
  EXPECT_EQ(nextReport(), "signal 9, copies are there");
  order({SupervisorCommand::kResume, left[1], {}});
  EXPECT_EQ(nextReport(), "signal 9, resumed");
  shutdown(world.supervisor, SHUT_WR);
  EXPECT_EQ(nextReport(), "signal 9, all have ended");
  EXPECT_EQ(kill(left[1], 0), -1);
}

TEST_F(LeftCopies, OnlyAChildOfTheSupervisorResumes) {
  order({SupervisorCommand::kResume, getpid(), {left[0], left[1], left[2]}});
  EXPECT_EQ(nextReport(), "exit 7, all have ended");
  for (const pid_t one : left) EXPECT_EQ(kill(one, 0), -1);
}

TEST_F(LeftCopies, CopiesWaitForALateOrder) {
  pollfd readable{world.supervisor, POLLIN, 0};
  EXPECT_EQ(poll(&readable, 1, 1'200), 0);
  for (const pid_t one : left) EXPECT_EQ(kill(one, 0), 0);
  shutdown(world.supervisor, SHUT_WR);
  EXPECT_EQ(nextReport(), "exit 7, all have ended");
  for (const pid_t one : left) EXPECT_EQ(kill(one, 0), -1);
}

}  // namespace
}  // namespace naiad
