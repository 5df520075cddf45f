#include "client/terminal/TerminalGuard.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace naiad {
namespace {

constexpr std::string_view kMouseOn = "\033[?1003h\033[?1006h";
constexpr std::string_view kPasteAndFocusOn = "\033[?2004h\033[?1004h";
constexpr std::string_view kKittyQuery = "\033[?u";
constexpr std::string_view kKittyPush = "\033[>31u";
constexpr std::string_view kKittyPop = "\033[<u";
// Switches on Windows Terminal's key records; other terminals ignore this.
constexpr std::string_view kRecordsOn = "\033[?9001h";
constexpr std::string_view kModesOff = "\033[?9001l\033[?1006l\033[?1003l\033[?2004l\033[?1004l";
// Written at exits that cannot call ncurses: plain colours, cursor on, normal screen.
constexpr std::string_view kScreenOff = "\033[m\033[?25h\033[?1049l";

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGQUIT};
constexpr int kTerminating[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int kReported[] = {SIGINT, SIGTERM, SIGHUP, SIGWINCH, SIGTSTP, SIGCONT};
constexpr int kWriteTimeoutMillis = 1000;  // time limit for a terminal that accepts no bytes
constexpr int kForegroundMillis = 100;     // interval of checks for the foreground

// Data that the signal handlers read: lock-free, and initialised before the handlers are installed.
termios g_original;
volatile sig_atomic_t g_taken = 0;  ///< 1 while the terminal may be in raw mode
volatile sig_atomic_t g_modes_on = 0;
volatile sig_atomic_t g_kitty = 0;
volatile sig_atomic_t g_end_asked = 0;
pthread_t g_thread;  ///< the thread that draws
int g_pipe[2] = {-1, -1};
alignas(16) char g_signal_stack[64 * 1024];

void put(std::string_view bytes) {
  TerminalGuard::write(bytes.data(), bytes.size());
}

/// Async-signal-safe: calls only write(), poll() and tcsetattr(). g_taken is reset last: a handler that
/// interrupts this, at exit(), restores everything itself before it ends the process.
void restoreNow() {
  if (!g_taken) return;
  pollfd waiting{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&waiting, 1, kWriteTimeoutMillis) > 0) {
    if (g_kitty) put(kKittyPop);
    put(kModesOff);
    put(kScreenOff);
  }
  tcsetattr(STDIN_FILENO, TCSANOW, &g_original);
  g_kitty = 0;
  g_taken = 0;
}

/// Returns the process that can move this process group to the foreground: the parent of the group's leader,
/// or of this process if the leader has ended.
pid_t shellOfGroup() {
  std::ifstream file("/proc/" + std::to_string(getpgrp()) + "/stat");
  std::string stat;
  std::getline(file, stat);
  const std::size_t name_end = stat.rfind(')');
  pid_t parent = 0;
  const bool good = name_end != std::string::npos && sscanf(&stat[name_end], ") %*c %d", &parent) == 1;
  return good ? parent : getppid();
}

/// Waits until the process group is in the foreground: it may have been continued in the background. Returns
/// false if a signal asks the process to end, or its shell or terminal is gone. The process does not stop
/// itself again: the shell takes it for running and would send no SIGCONT after a terminating signal.
bool waitForForeground(pid_t shell) {
  while (!g_end_asked) {
    const pid_t foreground = tcgetpgrp(STDIN_FILENO);
    if (foreground < 0 || shellOfGroup() != shell) return false;
    if (foreground == getpgrp()) return true;
    poll(nullptr, 0, kForegroundMillis);
  }
  return false;
}

void dieOf(int signal) {
  restoreNow();
  ::signal(signal, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  sigprocmask(SIG_UNBLOCK, &set, nullptr);
  raise(signal);
}

bool isTerminating(int signal) {
  return std::find(std::begin(kTerminating), std::end(kTerminating), signal) != std::end(kTerminating);
}

/// Passes a signal to the drawing thread, which must not draw during a restore. False in that thread itself.
bool forward(int signal) {
  if (pthread_equal(pthread_self(), g_thread) != 0) return false;
  pthread_kill(g_thread, signal);
  return true;
}

void onCrash(int signal) {
  while (forward(signal)) pause();
  dieOf(signal);
}

void onReported(int signal) {
  if (forward(signal)) return;
  const int saved = errno;
  const bool asks_to_end = isTerminating(signal);
  if (asks_to_end && g_end_asked) dieOf(signal);
  if (asks_to_end) g_end_asked = 1;
  const char byte = static_cast<char>(signal);
  [[maybe_unused]] const ssize_t written = ::write(g_pipe[1], &byte, 1);
  errno = saved;
}

/// Handlers run with all signals blocked, so that no signal ends the process while one restores the terminal.
void install(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigfillset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

bool TerminalGuard::isTerminal() {
  return isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1;
}

TerminalGuard::TerminalGuard(Options options) : m_options(options) {
  if (tcgetattr(STDIN_FILENO, &g_original) != 0) throw std::runtime_error("standard input is not a terminal");
  if (pipe2(g_pipe, O_CLOEXEC | O_NONBLOCK) != 0) throw std::runtime_error("cannot create a pipe");
  g_end_asked = 0;
  g_thread = pthread_self();
  static const bool at_exit = std::atexit(restoreNow) == 0;
  (void)at_exit;
  installHandlers();
  setRawMode();
}

TerminalGuard::~TerminalGuard() {
  restore();
  for (const int signal : kCrashes) install(signal, SIG_DFL, 0);
  for (const int signal : kReported) install(signal, SIG_DFL, 0);
  // A terminating signal that the event loop has not read must still end the process.
  int unread = 0;
  for (unsigned char signal = 0; ::read(g_pipe[0], &signal, 1) == 1;)
    if (isTerminating(signal)) unread = signal;
  if (unread != 0) raise(unread);
  close(g_pipe[0]);
  close(g_pipe[1]);
  g_pipe[0] = g_pipe[1] = -1;
}

void TerminalGuard::installHandlers() {
  // After a stack overflow the handler needs another stack to restore the terminal.
  stack_t stack{};
  stack.ss_sp = g_signal_stack;
  stack.ss_size = sizeof g_signal_stack;
  sigaltstack(&stack, nullptr);
  for (const int signal : kCrashes) install(signal, onCrash, SA_ONSTACK);
  for (const int signal : kReported) install(signal, onReported, SA_RESTART);
  install(SIGPIPE, SIG_IGN, 0);
}

void TerminalGuard::setRawMode() {
  termios raw = g_original;
  raw.c_iflag &= ~static_cast<tcflag_t>(BRKINT | ICRNL | INLCR | IGNCR | INPCK | ISTRIP | IXON);
  raw.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  raw.c_cflag |= CS8;
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  g_taken = 1;
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

// Uses TCSAFLUSH, so that mouse reports still arriving do not end up in the shell's command line.
void TerminalGuard::setOriginalMode() {
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &g_original);
  g_taken = 0;
}

void TerminalGuard::enterModes() {
  g_modes_on = 1;
  if (m_options.mouse) put(kMouseOn);
  put(kPasteAndFocusOn);
  put(kRecordsOn);
  put(kKittyQuery);
}

void TerminalGuard::leaveModes() {
  popKitty();
  if (!g_modes_on) return;
  g_modes_on = 0;
  put(kModesOff);
}

void TerminalGuard::pushKitty() {
  if (g_kitty) return;
  g_kitty = 1;
  put(kKittyPush);
}

void TerminalGuard::popKitty() {
  if (!g_kitty) return;
  put(kKittyPop);
  g_kitty = 0;
}

void TerminalGuard::queryKitty() {
  put(kKittyQuery);
}

bool TerminalGuard::stopProcess() {
  const pid_t shell = shellOfGroup();
  const bool has_shell = tcgetpgrp(STDIN_FILENO) > 0;
  install(SIGTSTP, SIG_DFL, 0);
  // Stop the whole group, as the terminal does: a parent that waits for this process (a script, sudo) must
  // stop as well.
  kill(0, SIGTSTP);
  const bool goes_on = has_shell ? waitForForeground(shell) : g_end_asked == 0;
  installHandlers();
  return goes_on;
}

int TerminalGuard::signalFd() const {
  return g_pipe[0];
}

void TerminalGuard::restore() {
  if (!g_taken) return;
  leaveModes();
  if (m_end_screen) m_end_screen();
  m_end_screen = nullptr;
  setOriginalMode();
}

void TerminalGuard::write(const char* bytes, unsigned long size) {
  while (size > 0) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes, size);
    if (written > 0) {
      bytes += written;
      size -= static_cast<unsigned long>(written);
    } else if (written < 0 && errno == EAGAIN) {
      pollfd waiting{STDOUT_FILENO, POLLOUT, 0};
      if (poll(&waiting, 1, kWriteTimeoutMillis) <= 0) return;
    } else if (written < 0 && errno != EINTR) {
      return;
    }
  }
}

}  // namespace naiad
