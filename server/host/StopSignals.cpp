#include "StopSignals.h"

namespace naiad {

namespace {

volatile std::sig_atomic_t g_asked = 0;

void ask(int /*signal*/) {
  g_asked = 1;
}

}  // namespace

StopSignals::StopSignals() {
  g_asked = 0;
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
  return g_asked != 0;
}

}  // namespace naiad
