#include "host/process/StopSignals.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>

namespace naiad {

namespace {

// Lock-free, as signal handlers need it, and shared by the hosts of a process (tests have several).
constinit std::atomic<int> g_count = 0;
constinit std::atomic<int> g_signal = 0;
constinit std::atomic<bool> g_hung_up = false;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void ask(int signal) {
  g_signal = signal;
  ++g_count;
}

void onHangup(int /*signal*/) {
  g_hung_up = true;
}

// Call before a signal comes, because the terminal may be gone afterwards.
bool hasControllingTerminal() {
  const int terminal = ::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (terminal >= 0) ::close(terminal);
  return terminal >= 0;
}

void handle(int signal, void (*handler)(int), struct sigaction& before) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // games do not expect EINTR
  sigaction(signal, &action, &before);
}

}  // namespace

StopSignals::StopSignals() {
  g_count = 0;
  g_hung_up = false;
  handle(SIGINT, ask, m_before_int);
  handle(SIGTERM, ask, m_before_term);
  handle(SIGHUP, hasControllingTerminal() ? ask : onHangup, m_before_hup);
  if (m_before_hup.sa_handler == SIG_IGN) sigaction(SIGHUP, &m_before_hup, nullptr);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &m_before_int, nullptr);
  sigaction(SIGTERM, &m_before_term, nullptr);
  sigaction(SIGHUP, &m_before_hup, nullptr);
}

int StopSignals::count() const {
  return g_count;
}

int StopSignals::signal() const {
  return g_signal;
}

bool StopSignals::popHangup() {
  return g_hung_up.exchange(false);
}

}  // namespace naiad
