// Counts SIGINT, SIGTERM and SIGHUP while a server runs: the first asks it to end, the second to end at once.
#pragma once

#include <csignal>

namespace naiad {

/// Handlers are installed while this exists; a signal counts for all objects. If the process has a
/// controlling terminal when this is made, SIGHUP asks for the end, too, because it means that the terminal
/// is gone. Without a terminal, popHangup() reports it. If SIGHUP is ignored (nohup), it stays ignored.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns the number of signals that have asked for the end since this was installed. Any thread.
  int count() const;
  /// Returns the newest signal that has asked for the end. Any thread.
  int signal() const;
  /// True, once, after a SIGHUP that does not ask for the end.
  bool popHangup();

 private:
  struct sigaction m_before_int {};
  struct sigaction m_before_term {};
  struct sigaction m_before_hup {};
};

}  // namespace naiad
