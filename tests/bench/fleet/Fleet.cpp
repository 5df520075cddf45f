#include "Fleet.h"

#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>
#include <variant>

#include "shared/admin/AdminRequest.h"
#include "shared/admin/ControlClient.h"

namespace bench {
namespace {

namespace fs = std::filesystem;
using naiad::test::contentOf;

constexpr std::chrono::seconds kPatience{60};

void await(const std::string& what, const fs::path& folder, const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error(what + " does not start: " + folder.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::uint16_t portIn(const fs::path& path) {
  return static_cast<std::uint16_t>(std::atoi(contentOf(path).c_str()));
}

/// Returns the counter `name` from the last line that has it; nullopt if none has it, because lines omit
/// counters that are 0.
std::optional<std::uint64_t> counter(const std::string& log, const std::string& name) {
  const std::size_t at = log.rfind(" " + name + "=");
  if (at == std::string::npos) return std::nullopt;
  return std::strtoull(log.c_str() + at + name.size() + 2, nullptr, 10);
}

std::uint64_t fact(const naiad::AdminAnswer& status, const std::string& name) {
  for (const auto& [key, value] : status.facts) {
    if (key == name && std::holds_alternative<std::int64_t>(value))
      return static_cast<std::uint64_t>(std::get<std::int64_t>(value));
  }
  return 0;
}

}  // namespace

Fleet::Fleet(const FleetSetup& setup) : m_setup(setup) {
  startBus();
  startDirectory();
  for (int i = 0; i < setup.servers; ++i) {
    m_servers.push_back({m_folder / ("server" + std::to_string(i + 1)), 0, {}});
    fs::create_directories(m_servers.back().folder);
    startServer(m_servers.size() - 1);
  }
  for (Server& server : m_servers) {
    await("dfserver", server.folder, [&] { return (server.port = portIn(server.folder / "port")) != 0; });
  }
  const auto listed = [this] {
    const std::string list = contentOf(m_folder / "servers.json");
    std::size_t count = 0;
    for (std::size_t at = 0; (at = list.find("\"link\"", at)) != std::string::npos; ++at) ++count;
    return count == m_servers.size();
  };
  await("a server on the bus", m_folder, listed);
}

void Fleet::startBus() {
  if (!m_bus.start()) throw std::runtime_error("nats-server does not start");
}

void Fleet::startDirectory() {
  m_directory.emplace(
      startLogged({NAIAD_BINARY_DIR "/dfdir", "--bus", m_bus.url(), "--list", m_folder / "servers.json",
                   "--listen", "127.0.0.1:0", "--identity", m_folder / "directory", "--port-file",
                   m_folder / "directory.port", "--max-per-address", std::to_string(m_setup.bots)},
                  m_folder / "directory.log"));
  await("dfdir", m_folder, [this] { return (m_directory_port = portIn(m_folder / "directory.port")) != 0; });
}

std::string Fleet::link() const {
  const std::string log = contentOf(m_folder / "directory.log");
  const std::size_t begin = log.find("naiad://");
  return log.substr(begin, log.find('\'', begin) - begin);
}

void Fleet::startServer(std::size_t number) {
  Server& server = m_servers.at(number);
  const std::string name = server.folder.filename();
  const std::string places = std::to_string(m_setup.max_players);
  const std::string folder = server.folder.string();
  server.process.reset();
  server.log_begin = contentOf(server.folder / "log").size();
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

// Reads the counters before the kill, because a killed process loses them. A hanging server does not answer.
void Fleet::killServer(std::size_t number) {
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

// Sends each program only one signal, because a second one may end a server before it writes its last line.
void Fleet::end() {
  for (Server& server : m_servers) server.process->signal(SIGTERM);
  for (Server& server : m_servers) {
    if (!server.process->waitForEnd(kPatience))
      throw std::runtime_error("a server does not end: " + server.folder.string());
    const std::string log = contentOf(server.folder / "log").substr(server.log_begin);
    const auto all = counter(log, "ticks");
    if (!all) throw std::runtime_error("a server has not counted its ticks: " + server.folder.string());
    m_ticks.all += *all;
    m_ticks.late += counter(log, "late_ticks").value_or(0);
  }
  m_directory->signal(SIGTERM);
  m_directory->waitForEnd(kPatience);
}

}  // namespace bench
