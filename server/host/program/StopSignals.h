// SIGINT and SIGTERM, while a server runs: the first one asks, the second one kills.
#pragma once

#include <csignal>

namespace naiad {

/// Installed while it lives; a signal asks all that are. A game that hangs in a handler never returns to a
/// check of isAsked(), so the second signal has its default effect and ends the process at once.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// A signal has come since this was installed.
  bool isAsked() const;

 private:
  struct sigaction m_before_int {};
  struct sigaction m_before_term {};
};

}  // namespace naiad
