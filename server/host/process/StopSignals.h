// Counts SIGINT, SIGTERM and SIGHUP while a server runs: the first asks it to end, the second to end at once.
#pragma once

#include <csignal>

namespace naiad {

/// Handlers are installed while this exists; a signal counts for all objects. SIGHUP asks for the end like
/// the others if the process has a controlling terminal when this is made: that terminal is gone. Without a
/// terminal it is reported by popHangup(). If it is ignored (nohup), it stays so.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns the number of signals that have asked for the end since this was installed. Any thread.
  int count() const;
  bool isStopRequested() const { return count() > 0; }
  /// Returns the last of these signals. Any thread.
  int signal() const;
  /// True, once, after a SIGHUP that does not ask for the end.
  bool popHangup();

 private:
  struct sigaction m_before_int {};
  struct sigaction m_before_term {};
  struct sigaction m_before_hup {};
};

}  // namespace naiad
