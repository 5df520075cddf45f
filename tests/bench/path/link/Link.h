// Carries packets between two networks.
#pragma once

#include "Direction.h"
#include "LinkCounters.h"

namespace bench::path {

class Link {
 public:
  /// `server_tun` and `client_tun` do not block; `counters` outlive the link.
  Link(int server_tun, int client_tun, const DirectionOptions& down, const DirectionOptions& up,
       LinkCounters& counters);

  /// Wait for packets and hand over those whose time has come, for at most `limit`.
  void run(Nanoseconds limit);

 private:
  static void read(int tun, Direction& direction);
  void deliver(int tun, Direction& direction);
  Nanoseconds waitingTime(Nanoseconds until) const;

  int m_server_tun;
  int m_client_tun;
  Direction m_down;
  Direction m_up;
  LinkCounters& m_counters;
};

}  // namespace bench::path
