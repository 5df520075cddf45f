// A program that runs in a terminal of 80×24 cells.
#pragma once

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "../Argv.h"
#include "../Monotonic.h"
#include "../scene/Picture.h"

namespace bench::path {

class PtyProgram {
 public:
  /// Starts the program with TERM=xterm-256color. Throws std::runtime_error.
  explicit PtyProgram(const std::vector<std::string>& command) : m_buffer(65536) {
    winsize size{};
    size.ws_col = kWidth;
    size.ws_row = kHeight;
    m_pid = forkpty(&m_terminal, nullptr, nullptr, &size);
    if (m_pid < 0) throw std::runtime_error("there is no terminal to be had");
    if (m_pid == 0) becomeCommand(command);
  }
  /// Closes the terminal, and kills the program if it does not end.
  ~PtyProgram() {
    close(m_terminal);
    kill(m_pid, SIGHUP);
    for (int i = 0; i < 50; ++i) {
      if (waitpid(m_pid, nullptr, WNOHANG) != 0) return;
      usleep(10'000);
    }
    kill(m_pid, SIGKILL);
    waitpid(m_pid, nullptr, 0);
  }
  PtyProgram(const PtyProgram&) = delete;
  PtyProgram& operator=(const PtyProgram&) = delete;

  /// Returns the next output; empty at the deadline, or when the program has ended.
  std::string_view read(Nanoseconds deadline) {
    pollfd terminal{m_terminal, POLLIN, 0};
    const timespec timeout = toTimespec(std::max(deadline - monotonicNow(), Nanoseconds(0)));
    if (ppoll(&terminal, 1, &timeout, nullptr) <= 0) return {};
    const ssize_t size = ::read(m_terminal, m_buffer.data(), m_buffer.size());
    if (size > 0) return {m_buffer.data(), static_cast<std::size_t>(size)};
    if (size == 0 || (errno != EINTR && errno != EAGAIN)) m_ended = true;
    return {};
  }
  bool hasEnded() const { return m_ended; }
  /// Types these bytes.
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t size = ::write(m_terminal, bytes.data(), bytes.size());
      if (size <= 0) return;  // the program has ended, which read() notices
      bytes.remove_prefix(static_cast<std::size_t>(size));
    }
  }

 private:
  [[noreturn]] static void becomeCommand(const std::vector<std::string>& command) {
    setenv("TERM", "xterm-256color", 1);
    setenv("LC_ALL", "C.UTF-8", 1);
    std::vector<char*> argv = argvOf(command);
    execvp(argv[0], argv.data());
    _exit(127);
  }

  int m_terminal = -1;
  pid_t m_pid = -1;
  bool m_ended = false;
  std::vector<char> m_buffer;
};

}  // namespace bench::path
