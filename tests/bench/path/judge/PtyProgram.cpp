#include "PtyProgram.h"

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include "../Argv.h"
#include "../scene/Picture.h"

namespace bench::path {

namespace {

constexpr std::size_t kBuffer = 65536;
constexpr int kCannotRun = 127;

[[noreturn]] void becomeCommand(const std::vector<std::string>& command) {
  setenv("TERM", "xterm-256color", 1);
  setenv("LC_ALL", "C.UTF-8", 1);
  std::vector<char*> argv = argvOf(command);
  execvp(argv[0], argv.data());
  _exit(kCannotRun);
}

}  // namespace

PtyProgram::PtyProgram(const std::vector<std::string>& command) : m_buffer(kBuffer) {
  winsize size{};
  size.ws_col = kWidth;
  size.ws_row = kHeight;
  m_pid = forkpty(&m_terminal, nullptr, nullptr, &size);
  if (m_pid < 0) throw std::runtime_error("there is no terminal to be had");
  if (m_pid == 0) becomeCommand(command);
}

PtyProgram::~PtyProgram() {
  close(m_terminal);
  kill(m_pid, SIGHUP);
  for (int i = 0; i < 50; ++i) {
    if (waitpid(m_pid, nullptr, WNOHANG) != 0) return;
    usleep(10'000);
  }
  kill(m_pid, SIGKILL);
  waitpid(m_pid, nullptr, 0);
}

std::string_view PtyProgram::read(Nanoseconds deadline) {
  pollfd terminal{m_terminal, POLLIN, 0};
  const timespec timeout = toTimespec(std::max(deadline - monotonicNow(), Nanoseconds(0)));
  if (ppoll(&terminal, 1, &timeout, nullptr) <= 0) return {};
  const ssize_t size = ::read(m_terminal, m_buffer.data(), m_buffer.size());
  if (size > 0) return {m_buffer.data(), static_cast<std::size_t>(size)};
  if (size == 0 || (errno != EINTR && errno != EAGAIN)) m_ended = true;
  return {};
}

void PtyProgram::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t size = ::write(m_terminal, bytes.data(), bytes.size());
    if (size <= 0) return;  // it has gone; read() notices
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace bench::path
