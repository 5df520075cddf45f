// A fleet on this machine: nats-server, dfdir and dfservers, each in its own folder.
#pragma once

#include <signal.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "shared/admin/AdminRequest.h"
#include "shared/admin/ControlClient.h"
#include "tests/bench/Process.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

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
  explicit Fleet(const FleetSetup& setup) : m_setup(setup) {
    startBus();
    startDirectory();
    for (int i = 0; i < setup.servers; ++i) {
      m_servers.push_back({m_folder / ("server" + std::to_string(i + 1)), 0, {}});
      std::filesystem::create_directories(m_servers.back().folder);
      startServer(m_servers.size() - 1);
    }
    for (Server& server : m_servers) {
      await("dfserver", [&] { return (server.port = portIn(server.folder / "port")) != 0; });
    }
    const auto listed = [this] {
      const int count = naiad::test::countIn(naiad::test::contentOf(m_folder / "servers.json"), "\"link\"");
      return count == static_cast<int>(m_servers.size());
    };
    await("a server on the bus", listed);
  }
  /// Returns the link to the directory.
  std::string link() const {
    const std::string log = naiad::test::contentOf(m_folder / "directory.log");
    const std::size_t begin = log.find("naiad://");
    return log.substr(begin, log.find('\'', begin) - begin);
  }
  std::size_t size() const { return m_servers.size(); }
  std::uint16_t port(std::size_t server) const { return m_servers.at(server).port; }
  /// Kills a server with SIGKILL after reading its tick counters, which the process loses. A hanging server
  /// does not answer. startServer() may start it again.
  void killServer(std::size_t number) {
    Server& server = m_servers.at(number);
    try {
      naiad::ControlClient control(server.folder / "control.sock");
      const naiad::AdminAnswer status = control.sendRequest(naiad::readAdminRequest({"status"}));
      m_ticks.all += fact(status, "ticks");
      m_ticks.late += fact(status, "late_ticks");
    } catch (const naiad::ServerUnreachable& error) {
      std::fprintf(stderr, "naiad_fleet: %s\n", error.what());
    }
    server.process->kill();
  }
  void startServer(std::size_t number) {
    Server& server = m_servers.at(number);
    const std::string name = server.folder.filename();
    const std::string places = std::to_string(m_setup.max_players);
    const std::string folder = server.folder.string();
    server.process.reset();
    server.log_begin = naiad::test::contentOf(server.folder / "log").size();
    const std::vector<std::string> words{NAIAD_BINARY_DIR "/dfserver",
                                         "--address=127.0.0.1",
                                         "--public-host=127.0.0.1",
                                         "--lan=off",
                                         "--game=hello",
                                         "--port=" + std::to_string(server.port),
                                         "--frame-time=" + std::to_string(1'000'000 / m_setup.hz),
                                         "--max-players=" + places,
                                         "--max-per-address=" + places,
                                         "--bus=" + m_bus.url(),
                                         "--bus-id=" + name,
                                         "--server-name=" + name,
                                         "--state=" + folder,
                                         "--identity=" + folder + "/identity",
                                         "--journal=" + folder + "/rounds",
                                         "--control=" + folder + "/control.sock",
                                         "--port-file=" + folder + "/port"};
    server.process.emplace(startLogged(words, server.folder / "log"));
  }
  void killBus() { m_bus.kill(); }
  void startBus() {
    if (!m_bus.start()) throw std::runtime_error("nats-server does not start");
  }
  /// Ends all programs by one signal each, because a second one may end a server before it writes its last
  /// line. Throws std::runtime_error if one does not end properly.
  void end() {
    for (Server& server : m_servers) server.process->signal(SIGTERM);
    for (Server& server : m_servers) {
      if (!server.process->waitForEnd(std::chrono::minutes(1)))
        throw std::runtime_error("a server does not end: " + server.folder.string());
      const std::string log = naiad::test::contentOf(server.folder / "log").substr(server.log_begin);
      const auto all = counter(log, "ticks");
      if (!all) throw std::runtime_error("a server has not counted its ticks: " + server.folder.string());
      m_ticks.all += *all;
      m_ticks.late += counter(log, "late_ticks").value_or(0);
    }
    m_directory->signal(SIGTERM);
    m_directory->waitForEnd(std::chrono::minutes(1));
  }
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
  static void await(const std::string& what, const std::function<bool()>& holds) {
    if (!naiad::test::waitUntil(holds)) throw std::runtime_error(what + " does not start");
  }
  static std::uint16_t portIn(const std::filesystem::path& path) {
    return static_cast<std::uint16_t>(std::atoi(naiad::test::contentOf(path).c_str()));
  }
  /// Returns the counter `name` from the last line that has it; nullopt if none has it, because lines omit
  /// counters that are 0.
  static std::optional<std::uint64_t> counter(const std::string& log, const std::string& name) {
    const std::size_t at = log.rfind(" " + name + "=");
    if (at == std::string::npos) return std::nullopt;
    return std::strtoull(log.c_str() + at + name.size() + 2, nullptr, 10);
  }
  static std::uint64_t fact(const naiad::AdminAnswer& status, const std::string& name) {
    for (const auto& [key, value] : status.facts) {
      if (key == name && std::holds_alternative<std::int64_t>(value))
        return static_cast<std::uint64_t>(std::get<std::int64_t>(value));
    }
    return 0;
  }
  void startDirectory() {
    m_directory.emplace(
        startLogged({NAIAD_BINARY_DIR "/dfdir", "--bus", m_bus.url(), "--list", m_folder / "servers.json",
                     "--listen", "127.0.0.1:0", "--identity", m_folder / "directory", "--port-file",
                     m_folder / "directory.port", "--max-per-address", std::to_string(m_setup.bots)},
                    m_folder / "directory.log"));
    await("dfdir", [this] { return (m_directory_port = portIn(m_folder / "directory.port")) != 0; });
  }

  FleetSetup m_setup;
  naiad::test::TempFolder m_folder;
  std::uint16_t m_directory_port = 0;
  naiad::test::NatsServer m_bus;
  std::optional<Process> m_directory;
  std::vector<Server> m_servers;
  Ticks m_ticks;  ///< ticks of servers that have ended
};

}  // namespace bench
