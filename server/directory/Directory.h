// The directory of a fleet: listens on the bus to servers that say they are there, writes a list of them for
// the web (FleetList.h), sends players to them (Lobby.h), and says to those that fill up where there is room
// (BusPayloads.h).
#pragma once

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/auth/ServerIdentity.h"
#include "host/fleet/Bus.h"
#include "server/directory/FleetList.h"
#include "server/directory/Lobby.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// What a directory is given, beside its log.
struct DirectorySettings {
  BusSettings bus;
  std::chrono::milliseconds interval = Presence::kInterval;  ///< in which its servers say that they are there
  std::string list;                                          ///< file for the list of servers; empty: none
  std::optional<LobbySettings> lobby;                        ///< nothing: none
  std::string identity;     ///< folder of the lobby's key; empty: the user's (ServerIdentity.h)
  std::string certificate;  ///< PEM file, in place of that folder; empty: none
  std::string key;          ///< the same
};

/// All of it happens in run(), on the thread that calls it.
class Directory {
 public:
  /// Throws std::runtime_error if the list cannot be written, ListenError, and TlsError for the lobby's key.
  /// The bus has no complaint (busComplaint()).
  Directory(DirectorySettings settings, LogLine log);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// SIGINT and SIGTERM stop it; SIGHUP opens the log again, and reads the lobby's key. A
  /// second one of the first two has its usual effect.
  void heedSignals();
  /// Serve until a signal comes.
  void run();

  /// Of the lobby; nothing without one.
  std::optional<std::uint16_t> port() const;
  std::optional<Fingerprint> fingerprint() const;

 private:
  class ListFile;
  using Time = std::chrono::steady_clock::time_point;

  void openLobby();
  void reload();
  void takeTurn(Time now);
  void sendOn(Time now);
  void awaitTurn();
  void stop();
  void logCounters();

  DirectorySettings m_settings;
  LogLine m_log;
  asio::io_context m_context{1};
  asio::steady_timer m_timer{m_context};
  asio::signal_set m_signals{m_context};
  std::unique_ptr<ListFile> m_file;
  FleetWatch m_fleet;
  std::optional<ServerIdentity> m_identity;
  std::optional<Lobby> m_lobby;
  Time m_said_room{};
};

}  // namespace naiad
