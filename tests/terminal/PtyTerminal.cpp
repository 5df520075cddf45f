#include "PtyTerminal.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace naiad::test {
namespace {

/// Timeout for a loaded machine. A test that reaches it has failed anyway.
constexpr std::chrono::seconds kPatience{60};
using Clock = std::chrono::steady_clock;

[[noreturn]] void runProgram(const PtyTerminal::Options& options) {
  setenv("TERM", "xterm-256color", 1);
  setenv("LC_ALL", "C.UTF-8", 1);
  unsetenv("NO_COLOR");
  setenv("NAIAD_JOURNAL", "off", 1);  // keeps test servers from writing into the user's state folder
  for (const auto& [name, value] : options.environment) {
    if (value.empty()) {
      unsetenv(name.c_str());
    } else {
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  std::vector<char*> arguments;
  for (const std::string& argument : options.command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

/// Makes `process` the terminal's foreground process group.
void bringToFront(pid_t process) {
  setpgid(process, process);
  std::signal(SIGTTOU, SIG_IGN);
  tcsetpgrp(STDIN_FILENO, process);
  std::signal(SIGTTOU, SIG_DFL);
}

/// Runs the program in the foreground, like a shell, and stays after its end, because the kernel discards a
/// terminal's unread output when the session leader ends. Reports the program's process id, then its status.
[[noreturn]] void leadSession(int slave, int report, const PtyTerminal::Options& options) {
  login_tty(slave);
  const pid_t program = options.leads ? 0 : fork();
  if (program == 0) {
    close(report);
    if (!options.leads) bringToFront(getpid());
    runProgram(options);
  }
  bringToFront(program);
  int values[2] = {program, 0};
  [[maybe_unused]] ssize_t written = ::write(report, &values[0], sizeof values[0]);
  while (waitpid(program, &values[1], 0) < 0 && errno == EINTR) {
  }
  written = ::write(report, &values[1], sizeof values[1]);
  for (;;) pause();
}

}  // namespace

PtyTerminal::PtyTerminal(const Options& options) : m_answer_kitty(options.answer_kitty) {
  winsize size{};
  size.ws_col = static_cast<unsigned short>(options.columns);
  size.ws_row = static_cast<unsigned short>(options.rows);
  if (openpty(&m_master, &m_slave, nullptr, nullptr, &size) != 0) throw std::runtime_error("openpty failed");
  fcntl(m_master, F_SETFD, FD_CLOEXEC);
  tcgetattr(m_slave, &m_original);
  int report[2];
  if (pipe2(report, O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
  m_leader = fork();
  if (m_leader < 0) throw std::runtime_error("fork failed");
  if (m_leader == 0) leadSession(m_slave, report[1], options);
  close(report[1]);
  m_report = report[0];
  m_pid = m_leader;
  if (!options.leads && ::read(m_report, &m_pid, sizeof m_pid) != sizeof m_pid)
    throw std::runtime_error("no program");
  fcntl(m_report, F_SETFL, O_NONBLOCK);
}

PtyTerminal::~PtyTerminal() {
  if (!hasExited()) kill(m_pid, SIGKILL);
  if (m_pid != m_leader || !m_exited) {
    kill(m_leader, SIGKILL);
    waitpid(m_leader, nullptr, 0);
  }
  close(m_report);
  close(m_slave);
  close(m_master);
}

bool PtyTerminal::hasExited() {
  if (m_exited) return true;
  m_exited = m_pid == m_leader ? waitpid(m_leader, &m_status, WNOHANG) > 0
                               : ::read(m_report, &m_status, sizeof m_status) == sizeof m_status;
  return m_exited;
}

void PtyTerminal::type(const std::string& bytes) {
  [[maybe_unused]] const ssize_t written = ::write(m_master, bytes.data(), bytes.size());
}

void PtyTerminal::resize(int columns, int rows) {
  winsize size{};
  size.ws_col = static_cast<unsigned short>(columns);
  size.ws_row = static_cast<unsigned short>(rows);
  ioctl(m_master, TIOCSWINSZ, &size);
}

void PtyTerminal::signal(int number) {
  kill(m_pid, number);
}

bool PtyTerminal::readOnce(std::chrono::milliseconds timeout) {
  pollfd waiting{m_master, POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(timeout.count())) <= 0) return false;
  std::array<char, 65536> bytes{};
  const ssize_t count = ::read(m_master, bytes.data(), bytes.size());
  if (count <= 0) return false;
  m_output.append(bytes.data(), static_cast<std::size_t>(count));
  static const std::string query = "\033[?u";
  for (auto at = m_output.find(query, m_answered); at != std::string::npos;
       at = m_output.find(query, m_answered)) {
    m_answered = at + query.size();
    if (m_answer_kitty) type("\033[?0u");
  }
  return true;
}

bool PtyTerminal::waitFor(const std::string& text) {
  const auto end = Clock::now() + kPatience;
  while (!hasWritten(text)) {
    if (Clock::now() > end) return false;
    const bool more = readOnce(std::chrono::milliseconds(50));
    if (!more && hasExited()) return hasWritten(text);
  }
  return true;
}

bool PtyTerminal::waitUntil(const std::function<bool()>& done) {
  const auto end = Clock::now() + kPatience;
  while (!done() && Clock::now() < end) readOnce(std::chrono::milliseconds(50));
  return done();
}

void PtyTerminal::read(std::chrono::milliseconds time) {
  for (const auto end = Clock::now() + time; Clock::now() < end;) readOnce(std::chrono::milliseconds(10));
}

int PtyTerminal::waitForExit() {
  const auto end = Clock::now() + kPatience;
  while (!hasExited()) {
    if (Clock::now() > end) return -1;
    readOnce(std::chrono::milliseconds(20));
  }
  while (readOnce(std::chrono::milliseconds(0))) {
  }
  return m_status;
}

termios PtyTerminal::currentModes() const {
  termios modes{};
  tcgetattr(m_slave, &modes);
  return modes;
}

bool sameModes(const termios& a, const termios& b) {
  return a.c_iflag == b.c_iflag && a.c_oflag == b.c_oflag && a.c_cflag == b.c_cflag &&
         a.c_lflag == b.c_lflag && a.c_cc[VMIN] == b.c_cc[VMIN] && a.c_cc[VTIME] == b.c_cc[VTIME];
}

std::string linkIn(const std::string& output) {
  const std::string before = "Join from this machine with: dfclient ";
  const std::size_t found = output.find(before);
  if (found == std::string::npos) return "";
  const std::size_t begin = found + before.size();
  return output.substr(begin, output.find_first_of("\r\n", begin) - begin);
}

std::string programPath(const std::string& name) {
  std::string variable;
  for (const char c : name)
    variable.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
  if (const char* path = std::getenv(variable.c_str())) return path;
  return std::string(NAIAD_BINARY_DIR) + "/" + name;
}

}  // namespace naiad::test
