#include "host/program/StopSignals.h"

#include <atomic>

namespace naiad {

namespace {

// Lock-free, so that a handler may touch it, and several hosts in one process (tests have them) may, too.
std::atomic<bool> g_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void ask(int /*signal*/) {
  g_asked = true;
}

}  // namespace

StopSignals::StopSignals() {
  g_asked = false;
  struct sigaction action {};
  action.sa_handler = ask;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the next one of the kind has its default effect
  sigaction(SIGINT, &action, &m_before_int);
  sigaction(SIGTERM, &action, &m_before_term);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &m_before_int, nullptr);
  sigaction(SIGTERM, &m_before_term, nullptr);
}

bool StopSignals::isAsked() const {
  return g_asked;
}

}  // namespace naiad
