#include "host/world/WorldSupervisor.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <set>
#include <string>

#include "host/world/ArgvPointers.h"
#include "host/world/Descendants.h"
#include "host/world/DescriptorMessage.h"
#include "host/world/Determinism.h"
#include "host/world/FixedAddresses.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldStart.h"

namespace naiad {

namespace {

/// True if `process` is a child that has not been waited for, alive or not.
bool isChild(pid_t process) {
  siginfo_t facts{};
  return process > 0 && waitid(P_PID, static_cast<id_t>(process), &facts, WEXITED | WNOHANG | WNOWAIT) == 0;
}

/// Reaps children that have ended. If `world` is one of them, stops and returns true, with its status.
bool reapWorld(pid_t world, int& status) {
  int how = 0;
  for (pid_t child = 0; (child = waitpid(-1, &how, WNOHANG)) > 0;) {
    if (child != world) continue;
    status = how;
    return true;
  }
  return false;
}

/// Supervises a world that makes copies. When the world ends, the front says which copy becomes the world.
/// Then the other descendants of the supervisor end, except for the copies that are kept.
class FailoverSupervisor {
 public:
  /// `world`: a child of this process, which has no threads and is a child subreaper. `front`: the
  /// supervisor's socket. `children`: a descriptor that is readable when a child has ended.
  FailoverSupervisor(pid_t world, int front, int children)
      : m_world(world), m_front(front), m_children(children) {}

  /// Runs until the front needs no world any more, or has ended, or no copy replaces a world that has ended.
  /// Reports each end of a world. Returns the world that is left; 0: it has ended, and status() says how.
  pid_t run() {
    while (waitForEnd()) {
      m_world = 0;
      SupervisorCommand next;
      if (!report(WorldExitReport::kWorld) || !waitForCommand(next) || !isChild(next.process)) return 0;
      std::set<pid_t> kept{next.process};
      kept.insert(next.kept.begin(), next.kept.end());
      if (!killOthers(kept) || !report(WorldExitReport::kRest)) return 0;
      m_world = next.process;
    }
    return m_world;
  }
  /// Returns the status of the last world that has ended, as of waitpid().
  int status() const { return m_status; }

 private:
  /// Waits for the world's end. Returns false if the front does not need the world any more.
  bool waitForEnd() {
    pollfd either[2] = {{m_front, POLLIN | POLLRDHUP, 0}, {m_children, POLLIN, 0}};
    while (!reapWorld(m_world, m_status)) {
      if (poll(either, 2, -1) < 0) continue;
      if (either[0].revents != 0) {
        SupervisorCommand order;
        if (!receiveCommand(order) || order.kind != SupervisorCommand::kEndWorld) return false;
        kill(m_world, SIGKILL);
      }
      signalfd_siginfo facts{};
      if (either[1].revents != 0) {
        [[maybe_unused]] const ssize_t got = read(m_children, &facts, sizeof facts);
      }
    }
    return true;
  }
  /// Returns false if there is no command, for example because the front has closed its end.
  bool receiveCommand(SupervisorCommand& order) const {
    return recv(m_front, &order, sizeof order, MSG_DONTWAIT) == sizeof order;
  }
  // Waits without a limit: a busy front must not lose its round, and the socket tells when the front ends.
  bool waitForCommand(SupervisorCommand& order) const {
    do {
      if (recv(m_front, &order, sizeof order, 0) != sizeof order) return false;
    } while (order.kind ==
             SupervisorCommand::kEndWorld);  // skips commands to end the world, which had already ended
    return true;
  }
  bool report(WorldExitReport::Kind what) const {
    const WorldExitReport end{m_status, what};
    return send(m_front, &end, sizeof end, MSG_NOSIGNAL) == sizeof end;
  }

  pid_t m_world;
  const int m_front;
  const int m_children;
  int m_status = 0;
};

constexpr int kFailure = STDERR_FILENO + 3;  ///< the world's descriptor for errors before execve()
constexpr int kFirstFree = kFailure + 1;
constexpr int kFront = STDERR_FILENO + 1;  ///< the launcher's end of the front's socket

/// Moves `descriptor` to the number `to`, and closes all descriptors above `to`.
void keepOnly(int descriptor, int to) {
  if (descriptor != to) dup2(descriptor, to);
  fcntl(to, F_SETFD, FD_CLOEXEC);
  close_range(static_cast<unsigned>(to) + 1, ~0u, 0);
}

/// Ignores the signals that end a server in order: only the front handles them.
void ignoreSignals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2, SIGTSTP})
    signal(number, SIG_IGN);
  signal(SIGCHLD, SIG_DFL);
}

/// Returns a descriptor that is readable when a child has ended.
int watchChildren() {
  sigset_t child;
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child, nullptr);
  return signalfd(-1, &child, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Raises the OOM score: if memory runs out, the kernel kills worlds before the front (the server's process).
void raiseOomScore() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = write(file, "300", 3);
  close(file);
}

/// Receives a request for a world, with its descriptors; nullopt if they are bad, or the front has ended.
std::optional<WorldDescriptors> receiveStartOptions(int from, WorldStartOptions& order) {
  WorldDescriptors::List list;
  list.fill(-1);
  const int count = receiveDescriptors(from, &order, sizeof order, list);
  if (count < 0) return std::nullopt;
  const WorldDescriptors numbers{list[0], list[1], list[2], list[3], list[4]};
  if (static_cast<std::size_t>(count) == WorldDescriptors::kMaxCount - (order.copies ? 0 : 1)) return numbers;
  numbers.closeAll();
  return std::nullopt;
}

// ---- the world's process, before it executes its program --------------------------------------------------

[[noreturn]] void fail(int failure, int error) {
  [[maybe_unused]] const ssize_t written = write(failure, &error, sizeof error);
  _exit(127);
}

/// Copies a descriptor to a number above the fixed ones, so that none is overwritten before its final copy.
int moveUp(int descriptor) {
  return fcntl(descriptor, F_DUPFD_CLOEXEC, kFirstFree);
}

void arrangeDescriptors(const WorldDescriptors& theirs, int failure) {
  const int world = moveUp(theirs.world);
  const int output = moveUp(theirs.output);
  const int page = moveUp(theirs.page);
  const int copies = theirs.copies >= 0 ? moveUp(theirs.copies) : -1;
  dup2(moveUp(failure), kFailure);
  fcntl(kFailure, F_SETFD, FD_CLOEXEC);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  dup2(world, kWorldSocket);
  dup2(page, kWorldPage);
  if (copies >= 0) dup2(copies, kWorldCheckpoints);
  close_range(kFirstFree, kWorldCheckpoints - 1, 0);
  close_range(kWorldCheckpoints + (copies >= 0 ? 1 : 0), ~0u, 0);
}

void restoreSignals() {
  for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

std::vector<std::string> environmentOf(const WorldProgram& program, const WorldStartOptions& order) {
  std::vector<std::string> entries = program.environment;
  entries.push_back(worldSocketEntry());
  if (order.seed != 0) entries.push_back(worldSeedEntry(order.seed));
  if (!order.repeatable) return entries;
  entries.push_back(determinismEntry(order));
  if (!program.preload.empty()) entries.push_back("LD_PRELOAD=" + program.preload);
  padEnvironment(program.program, program.arguments, entries);
  return entries;
}

Sandbox sandboxOf(const WorldProgram& program, const WorldStartOptions& order) {
  Sandbox sandbox = program.sandbox;
  if (!order.reads_only) return sandbox;
  sandbox.readable.insert(sandbox.readable.end(), sandbox.writable.begin(), sandbox.writable.end());
  sandbox.writable.clear();
  sandbox.appendable.clear();
  return sandbox;
}

[[noreturn]] void runWorld(const WorldDescriptors& descriptors, const WorldStartOptions& order, int failure,
                           pid_t supervisor, const WorldProgram& program, const SandboxSupport& support) {
  arrangeDescriptors(descriptors, failure);
  setsid();
  restoreSignals();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != supervisor) fail(kFailure, ECHILD);
  if (chdir(program.directory.c_str()) != 0) fail(kFailure, errno);
  std::vector<std::string> words = program.arguments;
  std::vector<std::string> entries = environmentOf(program, order);
  if (order.repeatable && support.addresses != 0) disableAslr();
  const std::vector<char*> arguments = argvPointers(words);
  const std::vector<char*> environment = argvPointers(entries);
  if (program.sandbox.on) {
    if (const int error = enterSandbox(sandboxOf(program, order), support); error != 0) fail(kFailure, error);
  }
  execve(program.program.c_str(), arguments.data(), environment.data());
  fail(kFailure, errno);
}

// ---- the supervisor ---------------------------------------------------------------------------------------

/// Returns false if the front has closed its end.
template <class Message>
bool sendTo(int front, const Message& message) {
  return send(front, &message, sizeof message, MSG_NOSIGNAL) == sizeof message;
}

/// True if this child has ended. Does not reap it, but reaps other children that have ended.
bool hasEnded(pid_t world) {
  siginfo_t facts{};
  while (waitid(P_ALL, 0, &facts, WEXITED | WNOHANG | WNOWAIT) == 0 && facts.si_pid != 0) {
    if (facts.si_pid == world) return true;
    waitpid(facts.si_pid, nullptr, WNOHANG);
    facts.si_pid = 0;
  }
  return false;
}

void waitForEnd(pid_t world, int front, int children) {
  pollfd either[2] = {{front, POLLIN | POLLRDHUP, 0}, {children, POLLIN, 0}};
  while (!hasEnded(world)) {
    if (poll(either, 2, -1) < 0) continue;
    if (either[0].revents != 0) return;
    signalfd_siginfo facts{};
    [[maybe_unused]] const ssize_t got = read(children, &facts, sizeof facts);
  }
}

[[noreturn]] void followWorlds(pid_t world, int front, int children) {
  FailoverSupervisor succession(world, front, children);
  const pid_t left = succession.run();
  const int status = killDescendants(left);
  sendTo(front, WorldExitReport{left > 0 ? status : succession.status()});
  _exit(0);
}

[[noreturn]] void runSupervisor(const WorldDescriptors& descriptors, const WorldStartOptions& order,
                                const WorldProgram& program, const SandboxSupport& support) {
  prctl(PR_SET_NAME, "df-supervisor");
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const int children = watchChildren();
  int failure[2];
  if (children < 0 || pipe2(failure, O_CLOEXEC) != 0) {
    sendTo(descriptors.supervisor, WorldStartReport{errno, -1});
    _exit(1);
  }
  const pid_t self = getpid();
  const pid_t world = fork();
  if (world == 0) runWorld(descriptors, order, failure[1], self, program, support);
  WorldStartReport begun{world < 0 ? errno : 0, world};
  for (const int one :
       {failure[1], descriptors.world, descriptors.output, descriptors.page, descriptors.copies})
    close(one);
  ssize_t got = 0;
  int error = 0;
  while ((got = read(failure[0], &error, sizeof error)) < 0 && errno == EINTR) continue;
  if (got == sizeof error) begun.error = error;
  close(failure[0]);
  const bool wanted = sendTo(descriptors.supervisor, begun);
  if (world > 0 && wanted && begun.error == 0 && order.copies)
    followWorlds(world, descriptors.supervisor, children);
  if (world > 0 && wanted && begun.error == 0) waitForEnd(world, descriptors.supervisor, children);
  if (world > 0) sendTo(descriptors.supervisor, WorldExitReport{killDescendants(world)});
  _exit(0);
}

// ---- the launcher -----------------------------------------------------------------------------------------

class Launcher {
 public:
  Launcher(const WorldProgram& program, const SandboxSupport& support)
      : m_program(program), m_support(support), m_children(watchChildren()) {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
  }

  /// Runs until the front has ended.
  void run() {
    pollfd either[2] = {{kFront, POLLIN, 0}, {m_children, POLLIN, 0}};
    while (true) {
      if (poll(either, 2, -1) < 0) continue;
      if (either[1].revents != 0) waitForChildren();
      if (either[0].revents == 0) continue;
      WorldStartOptions order;
      const auto descriptors = receiveStartOptions(kFront, order);
      if (!descriptors) return;
      startSupervisor(*descriptors, order);
    }
  }

 private:
  void startSupervisor(const WorldDescriptors& descriptors, const WorldStartOptions& order) {
    const pid_t supervisor = fork();
    if (supervisor == 0) {
      close(kFront);
      close(m_children);
      runSupervisor(descriptors, order, m_program, m_support);
    }
    if (supervisor < 0) sendTo(descriptors.supervisor, WorldStartReport{errno, -1});
    if (supervisor > 0) m_supervisors.insert(supervisor);
    descriptors.closeAll();
  }

  // Reaps ended children. If one is a supervisor that was killed, or was a descendant of such a supervisor,
  // kills all descendants of this process that have no supervisor.
  void waitForChildren() {
    signalfd_siginfo facts{};
    [[maybe_unused]] const ssize_t got = read(m_children, &facts, sizeof facts);
    bool strays = false;
    int status = 0;
    for (pid_t child = 0; (child = waitpid(-1, &status, WNOHANG)) > 0;) {
      const bool was_keeper = m_supervisors.erase(child) > 0;
      strays = strays || !was_keeper || WIFSIGNALED(status);
    }
    if (!strays) return;
    for (const pid_t child : findChildren()) {
      if (m_supervisors.count(child) == 0) killChild(child);
    }
    for (const Descendant& one : findDescendants()) {
      if (m_supervisors.count(one.branch) == 0) kill(one.process, SIGKILL);
    }
  }

  const WorldProgram& m_program;
  const SandboxSupport m_support;
  const int m_children;
  std::set<pid_t> m_supervisors;
};

}  // namespace

void WorldDescriptors::closeAll() const {
  for (const int one : {world, supervisor, output, page, copies}) close(one);
}

void runLauncher(int front, const WorldProgram& program) {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  const int away = fcntl(front, F_DUPFD_CLOEXEC, 3);
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, number);
  keepOnly(away, kFront);
  setsid();
  prctl(PR_SET_NAME, "df-launcher");
  raiseOomScore();
  makeUndumpable();
  ignoreSignals();
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + program.nice);
  SandboxSupport support = program.sandbox.on ? findSandboxSupport() : SandboxSupport{};
  support.addresses = canDisableAslr() ? 1 : 0;
  sendTo(kFront, support);
  Launcher(program, support).run();
  _exit(0);
}

}  // namespace naiad
