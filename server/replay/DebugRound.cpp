#include "server/replay/DebugRound.h"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <system_error>

#include "server/replay/Replay.h"

namespace naiad {

namespace {

constexpr const char* kDebugger = "gdb";
/// Makes the first `continue` run the tick, and not only report the signal that has stopped the world.
constexpr const char* kNoStop = "handle SIGSTOP nostop noprint nopass";

/// Time limit for the world to stop. Its state is polled, because only its parent is told that it stopped.
constexpr std::chrono::seconds kStopTimeout{10};

/// Returns the process's state letter from /proc; 0 if the process has ended. Searches from the end, because
/// the name before the letter may have any characters.
char stateOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() ? text[name_end + 2] : '\0';
}

void stopWorld(pid_t world) {
  if (world <= 0 || kill(world, SIGSTOP) != 0) throw RoundError("Cannot stop the game's process.");
  const auto end = std::chrono::steady_clock::now() + kStopTimeout;
  while (stateOf(world) != 'T') {
    if (std::chrono::steady_clock::now() >= end) throw RoundError("The game's process does not stop.");
    poll(nullptr, 0, 1);
  }
}

/// A descriptor that is closed at the end of its block.
class ScopedDescriptor {
 public:
  explicit ScopedDescriptor(int number) : m_number(number) {
    if (number < 0) throw std::system_error(errno, std::generic_category(), "waiting for the debugger");
  }
  ~ScopedDescriptor() { close(m_number); }
  ScopedDescriptor(const ScopedDescriptor&) = delete;
  ScopedDescriptor& operator=(const ScopedDescriptor&) = delete;
  int get() const { return m_number; }

 private:
  int m_number;
};

/// Starts gdb in this terminal, and ignores Ctrl-C, which is meant for gdb. Returns 0 if gdb cannot be
/// started.
pid_t startDebugger(pid_t world) {
  const std::string number = std::to_string(world);
  const char* words[] = {kDebugger, "-q", "-p", number.c_str(), "-ex", kNoStop, nullptr};
  for (const int one : {SIGINT, SIGQUIT}) signal(one, SIG_IGN);
  posix_spawnattr_t usual;
  posix_spawnattr_init(&usual);
  sigset_t restored;
  sigemptyset(&restored);
  for (const int one : {SIGINT, SIGQUIT, SIGPIPE}) sigaddset(&restored, one);
  posix_spawnattr_setsigdefault(&usual, &restored);
  posix_spawnattr_setflags(&usual, POSIX_SPAWN_SETSIGDEF);
  pid_t debugger = 0;
  const int error =
      posix_spawnp(&debugger, kDebugger, nullptr, &usual, const_cast<char* const*>(words), environ);
  posix_spawnattr_destroy(&usual);
  return error == 0 ? debugger : 0;
}

/// Returns a descriptor that becomes readable at the process's end. glibc 2.36 has pidfd_open() for C only.
int watchProcess(pid_t process) {
  return static_cast<int>(syscall(SYS_pidfd_open, process, 0));
}

void waitForDebugger(pid_t debugger) {
  int status = 0;
  while (waitpid(debugger, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) == 0) return;
  throw RoundError(std::string(kDebugger) + " exited with code " + std::to_string(WEXITSTATUS(status)) + ".");
}

/// Returns a descriptor that becomes readable when the user sends SIGINT, SIGTERM or SIGHUP to end the
/// program.
int watchSignals() {
  sigset_t ends;
  sigemptyset(&ends);
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) {
    signal(one, SIG_DFL);
    sigaddset(&ends, one);
  }
  sigprocmask(SIG_BLOCK, &ends, nullptr);
  return signalfd(-1, &ends, SFD_CLOEXEC);
}

/// Executes the remaining turns, until the world ends, the file ends, or the descriptor `ended` is readable.
void resumeRound(Replay& replay, int ended, std::ostream& out) {
  replay.world().setCancelDescriptor(ended);
  while (replay.step()) continue;
  const auto status = replay.world().popExitStatus();
  if (!status) return;
  out << "The world ended in tick " << replay.tick();
  if (WIFSIGNALED(*status)) out << ": SIG" << sigabbrev_np(WTERMSIG(*status));
  out << "." << std::endl;
}

void executeTo(Replay& replay, std::uint32_t tick) {
  const std::string which = "tick " + std::to_string(tick);
  while (replay.tick() + 1 < tick && replay.step()) continue;
  if (replay.world().failure().empty() && replay.hasNextTurn()) return;
  if (!replay.world().failure().empty())
    throw RoundError("The world " + replay.world().failure() + " in tick " + std::to_string(replay.tick()) +
                     ", before " + which + ".");
  throw RoundError("The round has no " + which + ": it has " + std::to_string(replay.tick()) + " ticks.");
}

}  // namespace

void debugRound(const RecordedRound& round, const ReplayEnvironment& environment, std::uint32_t until,
                std::ostream& out) {
  Replay replay(round, environment);
  replay.restoreDroppedInputs(until);
  executeTo(replay, until);
  if (replay.firstDifference() != 0)
    out << "note: the replay differs from the recording since tick " << replay.firstDifference() << "\n";
  const pid_t world = replay.world().process();
  stopWorld(world);
  const std::string which = "The world is process " + std::to_string(world) + ", before tick " +
                            std::to_string(until) + " of the round.";
  out << which << " `continue` executes that tick.\n" << std::flush;
  if (const pid_t debugger = startDebugger(world); debugger > 0) {
    const ScopedDescriptor ended(watchProcess(debugger));
    resumeRound(replay, ended.get(), out);
    return waitForDebugger(debugger);
  }
  out << kDebugger << " is not installed. In another terminal: " << kDebugger << " -p " << world << " -ex '"
      << kNoStop << "' (or attach another debugger), then continue. Ctrl-C here ends the game.\n"
      << std::flush;
  const ScopedDescriptor ended(watchSignals());
  resumeRound(replay, ended.get(), out);
}

}  // namespace naiad
