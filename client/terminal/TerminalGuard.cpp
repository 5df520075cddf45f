#include "client/terminal/TerminalGuard.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace naiad {
namespace {

constexpr std::string_view kMouseOn = "\033[?1003h\033[?1006h";
constexpr std::string_view kPasteOn = "\033[?2004h";
constexpr std::string_view kKittyQuery = "\033[?u";
constexpr std::string_view kKittyPush = "\033[>31u";
constexpr std::string_view kKittyPop = "\033[<u";
constexpr std::string_view kModesOff = "\033[?1006l\033[?1003l\033[?2004l";
// For exits that cannot call ncurses: plain colours, cursor on, normal screen.
constexpr std::string_view kScreenOff = "\033[m\033[?25h\033[?1049l";

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
constexpr int kReported[] = {SIGINT, SIGTERM, SIGHUP, SIGWINCH, SIGTSTP, SIGCONT};

// What the signal handlers read: lock-free and initialised before they are installed.
termios g_original;
volatile sig_atomic_t g_taken = 0;
volatile sig_atomic_t g_modes_on = 0;
volatile sig_atomic_t g_kitty = 0;
volatile sig_atomic_t g_end_asked = 0;
int g_pipe[2] = {-1, -1};
alignas(16) char g_signal_stack[64 * 1024];

void put(std::string_view bytes) {
  TerminalGuard::write(bytes.data(), bytes.size());
}

/// Async-signal-safe: write(), poll() and tcsetattr() only.
void restoreNow() {
  if (!g_taken) return;
  g_taken = 0;
  if (g_kitty) put(kKittyPop);
  g_kitty = 0;
  put(kModesOff);
  put(kScreenOff);
  tcsetattr(STDIN_FILENO, TCSANOW, &g_original);
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

void onReported(int signal) {
  const int saved = errno;
  const bool asks_to_end = signal == SIGINT || signal == SIGTERM || signal == SIGHUP;
  if (asks_to_end && g_end_asked) dieOf(signal);
  if (asks_to_end) g_end_asked = 1;
  const char byte = static_cast<char>(signal);
  [[maybe_unused]] const ssize_t written = ::write(g_pipe[1], &byte, 1);
  errno = saved;
}

void install(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

bool TerminalGuard::isTerminal() {
  return isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1;
}

TerminalGuard::TerminalGuard(Options options) : m_options(options) {
  if (tcgetattr(STDIN_FILENO, &g_original) != 0) throw std::runtime_error("standard input is no terminal");
  if (pipe2(g_pipe, O_CLOEXEC | O_NONBLOCK) != 0) throw std::runtime_error("no pipe for signals");
  g_end_asked = 0;
  g_taken = 1;
  static const bool at_exit = std::atexit(restoreNow) == 0;
  (void)at_exit;
  installHandlers();
  setRaw();
}

TerminalGuard::~TerminalGuard() {
  restore();
  for (const int signal : kCrashes) install(signal, SIG_DFL, 0);
  for (const int signal : kReported) install(signal, SIG_DFL, 0);
  close(g_pipe[0]);
  close(g_pipe[1]);
  g_pipe[0] = g_pipe[1] = -1;
}

void TerminalGuard::installHandlers() {
  // An overflowing stack must still find room to restore the terminal on.
  stack_t stack{};
  stack.ss_sp = g_signal_stack;
  stack.ss_size = sizeof g_signal_stack;
  sigaltstack(&stack, nullptr);
  for (const int signal : kCrashes) install(signal, dieOf, SA_ONSTACK | static_cast<int>(SA_RESETHAND));
  for (const int signal : kReported) install(signal, onReported, SA_RESTART);
  install(SIGPIPE, SIG_IGN, 0);
}

void TerminalGuard::setRaw() {
  termios raw = g_original;
  raw.c_iflag &= ~static_cast<tcflag_t>(BRKINT | ICRNL | INLCR | IGNCR | INPCK | ISTRIP | IXON);
  raw.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  raw.c_cflag |= CS8;
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

// TCSAFLUSH: mouse reports that are still arriving must not end up in the shell's command line.
void TerminalGuard::setOriginal() {
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &g_original);
}

void TerminalGuard::enterModes() {
  g_modes_on = 1;
  if (m_options.mouse) put(kMouseOn);
  put(kPasteOn);
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

bool TerminalGuard::kittyPushed() const {
  return g_kitty != 0;
}

void TerminalGuard::stopProcess() {
  install(SIGTSTP, SIG_DFL, 0);
  // The whole group, as the terminal does it: a parent that waits for this process (a script, sudo) must stop
  // as well.
  kill(0, SIGTSTP);
  installHandlers();
}

int TerminalGuard::signalFd() const {
  return g_pipe[0];
}

void TerminalGuard::restore() {
  if (!g_taken) return;
  leaveModes();
  if (m_end_screen) m_end_screen();
  m_end_screen = nullptr;
  setOriginal();
  g_taken = 0;
}

void TerminalGuard::write(const char* bytes, unsigned long size) {
  while (size > 0) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes, size);
    if (written > 0) {
      bytes += written;
      size -= static_cast<unsigned long>(written);
    } else if (written < 0 && errno == EAGAIN) {
      pollfd waiting{STDOUT_FILENO, POLLOUT, 0};
      if (poll(&waiting, 1, 1000) <= 0) return;
    } else if (written < 0 && errno != EINTR) {
      return;
    }
  }
}

}  // namespace naiad
