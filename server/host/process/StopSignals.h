// SIGINT, SIGTERM and SIGHUP while a server runs: the first one asks it to end, the second one insists.
#pragma once

#include <csignal>

namespace naiad {

/// Installed while it lives; a signal counts for all that are. SIGHUP asks for the end as the others do if
/// the process has a controlling terminal when this is made: that terminal is gone. Without one it only asks
/// for attention (takeHangUp). Where it is ignored (nohup), it stays so.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// How many signals have asked for the end since this was installed. Any thread.
  int count() const;
  bool isAsked() const { return count() > 0; }
  /// The last one of them. Any thread.
  int signal() const;
  /// A SIGHUP came that does not ask for the end. True once for all that came.
  bool takeHangUp();

 private:
  struct sigaction m_before_int {};
  struct sigaction m_before_term {};
  struct sigaction m_before_hup {};
};

}  // namespace naiad
