// The directory of a fleet: receives the servers' heartbeats from the bus, writes a list of servers for the
// web (FleetRegistry.h), redirects players to them (Lobby.h), and tells servers that are nearly full to which
// other server they can redirect players (BusPayloads.h).
#pragma once

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "host/auth/ServerIdentity.h"
#include "host/fleet/Bus.h"
#include "server/directory/FleetRegistry.h"
#include "server/directory/Lobby.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/program/LineLog.h"
#include "shared/program/PublishedFile.h"

namespace naiad {

struct DirectorySettings {
  BusSettings bus;
  std::chrono::milliseconds interval = Presence::kInterval;  ///< heartbeat interval of the servers
  std::string list;                                          ///< file for the list of servers; empty: none
  std::optional<LobbySettings> lobby;                        ///< nullopt: no lobby
  std::string identity;     ///< folder of the lobby's key; empty: the user's (ServerIdentity.h)
  std::string certificate;  ///< PEM file, used instead of `identity`; empty: none
  std::string key;          ///< PEM file of the certificate's private key
};

/// Serves in run(), on the thread that calls it. Only the list is written by a thread of its own.
class Directory {
 public:
  /// Throws std::runtime_error if the list cannot be written, ListenError, and TlsError for the lobby's key.
  /// The bus settings must be valid (validateBusSettings()).
  Directory(DirectorySettings settings, LogLine log);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// Installs signal handlers: SIGINT and SIGTERM stop the directory, and a second one of them has its
  /// default effect. SIGHUP reopens the log and reloads the lobby's key.
  void installSignalHandlers();
  /// Serves until a signal stops it.
  void run();

  /// Returns the lobby's port; fingerprint() returns its key. Both return nullopt without a lobby.
  std::optional<std::uint16_t> port() const;
  std::optional<Fingerprint> fingerprint() const;

 private:
  using Time = std::chrono::steady_clock::time_point;

  void openLobby();
  void reload();
  void poll(Time now);
  void publishRedirects(Time now);
  void schedulePoll();
  void stop();
  void logCounters();

  DirectorySettings m_settings;
  LogLine m_log;
  asio::io_context m_context{1};
  asio::steady_timer m_timer{m_context};
  asio::signal_set m_signals{m_context};
  std::optional<PublishedFile> m_file;  ///< the list of servers
  FleetMonitor m_fleet;
  std::optional<ServerIdentity> m_identity;
  std::optional<Lobby> m_lobby;
  Time m_published_at{};
};

}  // namespace naiad
