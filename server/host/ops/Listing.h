// Lets players find a server: in the local network, and by a file for lists on the web.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/net/LanResponder.h"
#include "host/ops/StatusFile.h"
#include "host/settings/HostOptions.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// On the host's thread.
class Listing {
 public:
  struct Server {
    std::string game;
    std::uint16_t port = 0;
    std::optional<Fingerprint> key;  ///< nothing: without encryption it is not to be found in the network
    std::string link;                ///< for players elsewhere; empty: unknown
  };
  /// By the options. Throws ListenError with HostOptions::lan "on" if there is no socket for the network's
  /// queries, and std::runtime_error for a status file that cannot be written.
  Listing(const HostOptions& options, const Server& server, LogLine log);

  /// Answer in the local network from now on.
  void start();
  /// Once a tick.
  void setPlayers(std::size_t playing);
  /// Be found no more.
  void stop();
  /// Log what became of the network's queries. After stop().
  void logCounters() const;

 private:
  std::unique_ptr<LanResponder> openLan(const HostOptions& options, const Server& server) const;

  LogLine m_log;
  std::unique_ptr<LanResponder> m_lan;   ///< null: not to be found in the local network
  std::unique_ptr<StatusFile> m_status;  ///< null: none is asked for
};

}  // namespace naiad
