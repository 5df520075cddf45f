#include "host/process/ChildProcess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace naiad {

namespace {

using Clock = std::chrono::steady_clock;

/// Maximum time to wait for the end of a killed process, which may not end while it waits for a disk.
constexpr std::chrono::seconds kKillTime{2};

/// A descriptor that is closed at the end of its block.
class OwnDescriptor {
 public:
  explicit OwnDescriptor(int number) : m_number(number) {}
  ~OwnDescriptor() { close(); }
  OwnDescriptor(const OwnDescriptor&) = delete;
  OwnDescriptor& operator=(const OwnDescriptor&) = delete;
  int get() const { return m_number; }
  void close() {
    if (m_number >= 0) ::close(m_number);
    m_number = -1;
  }

 private:
  int m_number;
};

int millisUntil(Clock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::clamp<long long>(left + 1, 0, 60'000));
}

/// Reads the output that is there, without waiting. Returns false at the end of the output.
bool readInto(std::string& output_text, int from) {
  char part[4096];
  while (true) {
    const ssize_t got = read(from, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got < 0 && errno == EAGAIN;
    const std::size_t room = ChildProcess::kMaxOutput - output_text.size();
    output_text.append(part, std::min(static_cast<std::size_t>(got), room));
  }
}

/// Reads until the process has ended, even if its children have not. False if it has not ended by `end`.
bool readUntilEnd(int handle, OwnDescriptor& output, Clock::time_point end, std::string& output_text) {
  while (true) {
    pollfd places[] = {{handle, POLLIN, 0}, {output.get(), POLLIN, 0}};
    const int count = poll(places, 2, millisUntil(end));
    if (count < 0 && errno != EINTR) return false;
    if (count > 0 && places[1].revents != 0 && !readInto(output_text, output.get())) output.close();
    if (count > 0 && places[0].revents != 0) break;
    if (Clock::now() >= end) return false;
  }
  if (output.get() >= 0) readInto(output_text, output.get());
  return true;
}

/// Gives the program the signals that a shell would give it, not those of this thread.
void useDefaultSignals(posix_spawnattr_t& attributes) {
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);  // Ctrl-C in the terminal must not end the program
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                           POSIX_SPAWN_SETPGROUP));
}

}  // namespace

// Returns 0 if the program cannot be started, or cancel() was called.
pid_t ChildProcess::start(const std::string& path, const std::vector<std::string>& arguments, int output) {
  const std::string name = std::filesystem::path(path).filename().string();
  std::vector<char*> words{const_cast<char*>(name.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  useDefaultSignals(attributes);
  pid_t child = 0;
  {
    const std::lock_guard lock(m_mutex);
    if (m_is_cancelled ||
        posix_spawn(&child, path.c_str(), &actions, &attributes, words.data(), environ) != 0)
      child = 0;
    m_process = child;
  }
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return child;
}

ChildExit ChildProcess::run(const std::string& path, const std::vector<std::string>& arguments,
                            std::chrono::milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  ChildExit result;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return result;
  OwnDescriptor output(ends[0]);
  OwnDescriptor input(ends[1]);
  if (fcntl(output.get(), F_SETFL, O_NONBLOCK) != 0) return result;
  const pid_t child = start(path, arguments, input.get());
  input.close();
  if (child == 0) return result;
  // glibc 2.36 declares pidfd_open() without extern "C".
  const OwnDescriptor handle(static_cast<int>(syscall(SYS_pidfd_open, child, 0)));
  if (!readUntilEnd(handle.get(), output, end, result.output_text)) {
    result.timed_out = true;
    kill(-child, SIGKILL);  // with its process group
    readUntilEnd(handle.get(), output, Clock::now() + kKillTime, result.output_text);
  }
  const std::lock_guard lock(m_mutex);
  m_process = 0;
  int status = 0;
  if (waitpid(child, &status, WNOHANG) != child) return result;
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  return result;
}

void ChildProcess::cancel() {
  const std::lock_guard lock(m_mutex);
  m_is_cancelled = true;
  if (m_process > 0) kill(-m_process, SIGKILL);
}

}  // namespace naiad
