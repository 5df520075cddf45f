// A program as a process that is measured, killed and restarted.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace bench {

/// Returns pointers to the words of a command, followed by a null, as exec() needs them.
inline std::vector<char*> argvOf(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  return argv;
}

class Process {
 public:
  /// Starts a command after calling `prepare` in the new process, which dies with the thread that started it.
  /// The exit code is 127 if the command cannot be run.
  template <class Prepare>
  Process(const std::vector<std::string>& command, Prepare prepare) {
    const std::vector<char*> argv = argvOf(command);
    m_child = ::fork();
    if (m_child != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    prepare();
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ~Process() { kill(); }
  Process(Process&& other) noexcept : m_child(std::exchange(other.m_child, -1)) {}
  Process& operator=(Process&&) = delete;

  bool isRunning() {
    if (m_child > 0 && ::waitpid(m_child, nullptr, WNOHANG) != 0) m_child = -1;
    return m_child > 0;
  }
  void signal(int number) const {
    if (m_child > 0) ::kill(m_child, number);
  }
  /// Sends SIGKILL and waits for the end.
  void kill() {
    signal(SIGKILL);
    wait();
  }
  /// Waits for the end. Returns the exit code, or 128 + the signal that ended the program.
  int wait() {
    int status = 0;
    if (m_child > 0) ::waitpid(m_child, &status, 0);
    m_child = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Waits for the end after a signal. If it does not end in this time, kills it and returns false.
  bool waitForEnd(std::chrono::milliseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (isRunning()) {
      if (std::chrono::steady_clock::now() > end) {
        kill();
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// Returns the processor time of all its threads so far, in microseconds; 0 if it does not run.
  double cpuMicros() const {
    clockid_t clock = 0;
    timespec time{};
    if (m_child <= 0 || clock_getcpuclockid(m_child, &clock) != 0 || clock_gettime(clock, &time) != 0)
      return 0;
    return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) / 1e3;
  }

 private:
  pid_t m_child = -1;
};

/// Starts a program whose output is appended to a file.
inline Process startLogged(const std::vector<std::string>& command, const std::string& log) {
  return Process(command, [&log] {
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
  });
}

}  // namespace bench
