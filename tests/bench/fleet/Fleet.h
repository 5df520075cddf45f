// A fleet on this machine: nats-server, dfdir and dfservers, each in its own folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/Process.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/TempFolder.h"

namespace bench {

struct FleetSetup {
  int servers = 10;
  int max_players = 128;  ///< per server
  int bots = 1000;
  int hz = 30;
};

class Fleet {
 public:
  /// Starts all programs. Throws std::runtime_error if one does not start.
  explicit Fleet(const FleetSetup& setup);
  /// Returns the link to the directory.
  std::string link() const;
  std::size_t size() const { return m_servers.size(); }
  std::uint16_t port(std::size_t server) const { return m_servers.at(server).port; }
  /// Kills a server with SIGKILL after reading its tick counters. startServer() may start it again.
  void killServer(std::size_t server);
  void startServer(std::size_t server);
  void killBus() { m_bus.kill(); }
  void startBus();
  /// Ends all programs. Throws std::runtime_error if one does not end properly.
  void end();
  struct Ticks {
    std::uint64_t all = 0;
    std::uint64_t late = 0;
  };
  /// Returns the ticks of all servers, including killed ones. Call after end().
  const Ticks& ticks() const { return m_ticks; }
  /// Returns the folder of the programs' files.
  const std::filesystem::path& folder() const { return m_folder; }

 private:
  struct Server {
    std::filesystem::path folder;
    std::uint16_t port = 0;
    std::optional<Process> process;
    std::size_t log_begin = 0;  ///< where the log of the present process begins in the file
  };
  void startDirectory();

  FleetSetup m_setup;
  naiad::test::TempFolder m_folder;
  std::uint16_t m_directory_port = 0;
  naiad::test::NatsServer m_bus;
  std::optional<Process> m_directory;
  std::vector<Server> m_servers;
  Ticks m_ticks;  ///< ticks of servers that have ended
};

}  // namespace bench
