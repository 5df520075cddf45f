// Attacks on what a host leaves open by default: rounds on disk, the ssh door, the bus.
#pragma once

#include <sys/stat.h>

#include <algorithm>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include "Attack.h"
#include "Guest.h"
#include "shared/net/stream/Fingerprint.h"
#include "tests/bench/Process.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/TempFolder.h"
#include "tests/terminal/PtyTerminal.h"

namespace bench::attack {
namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using naiad::test::contentOf;
using naiad::test::PtyTerminal;
using naiad::test::TempFolder;

/// Plays a round with `players` guests on a server with this folder, and kills it.
inline void playAndKill(const std::string& folder, int players) {
  ServerProcess server({}, folder);
  asio::io_context context{1};
  std::vector<std::unique_ptr<Guest>> guests;
  for (int i = 0; i < players; ++i) {
    guests.push_back(
        std::make_unique<Guest>(context, server.port(), addressIn(10, i), "before", server.password()));
  }
  for (const auto end = Clock::now() + 5s; Clock::now() < end;) {
    context.restart();
    context.run_one_for(10ms);
    const Clock::time_point now = Clock::now();
    for (const auto& guest : guests) {
      guest->update(now);
      if (guest->hasPicture(now)) guest->session()->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now);
    }
  }
  server.killNow();
}

/// Begins on a server that was killed with eight players and restarted after the time to reconnect.
class LateRestart : public Attack {
 public:
  void prepare(const std::string& folder) override {
    playAndKill(folder, 8);
    std::this_thread::sleep_for(61s);
  }
  void begin(const Target& /*target*/) override {}
};

/// Begins on a server whose folder of rounds has files that no server wrote.
class HostileRounds : public Attack {
 public:
  void prepare(const std::string& folder) override {
    playAndKill(folder, 1);
    std::vector<fs::path> rounds;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".dfr") rounds.push_back(entry.path());
    for (const fs::path& round : rounds) {
      const auto sibling = [&round](const char* ending) {
        return round.parent_path() / (round.stem().string() + ending + ".dfr");
      };
      const std::string text = contentOf(round);
      std::ofstream(sibling("a")) << text.substr(0, text.size() / 2);
      std::ofstream(sibling("b")) << std::string(64, '\xff')
                                  << text.substr(std::min<std::size_t>(64, text.size()));
      std::ofstream(sibling("c")) << text;
      fs::permissions(sibling("c"), fs::perms::all);
      ::mkfifo(sibling("d").c_str(), 0600);
      fs::create_symlink("/dev/zero", sibling("e"));
      m_planted += 5;
    }
  }
  void begin(const Target& /*target*/) override {}
  void addFigures(Figures& figures) override {
    figures.push_back({"planted", static_cast<double>(m_planted), m_planted == 0});
  }

 private:
  long long m_planted = 0;
};

/// Visitors of a door whose terminals have the largest sizes that ssh can request, and change them.
class LargeTerminals : public Attack {
 public:
  ServerSetup setup() const override {
    return {.arguments = {"--proxy-socket", m_folder / "visitors"}, .password = {}};
  }
  void begin(const Target& target) override {
    const auto key = naiad::Fingerprint::parse(target.server.fingerprint());
    std::ofstream(m_folder / "games.list")
        << "game naiad://127.0.0.1:" << target.server.port() << "#" << naiad::ShortKey::of(key.value()).text()
        << " " << (m_folder / "visitors").string() << "\n";
    for (int i = 0; i < kVisitors; ++i) {
      PtyTerminal::Options options;
      options.command = {std::string(NAIAD_BINARY_DIR) + "/dfdoor", "--games", m_folder / "games.list",
                         "--state", m_folder / "state"};
      options.environment["SSH_CONNECTION"] = addressIn(12, i) + " 50000 127.0.0.1 22";
      options.columns = options.rows = 3000;
      m_visitors.push_back(std::make_unique<PtyTerminal>(options));
      if (m_visitors.back()->waitFor("Your name?")) m_visitors.back()->type("visitor\r");
    }
  }
  void update(Time now) override {
    const bool resizes = now >= m_next;
    if (resizes) m_next = now + 500ms;
    for (const auto& visitor : m_visitors) {
      visitor->read(1ms);
      if (!resizes) continue;
      const int large = ++m_resizes % 2 == 0 ? 65535 : 3000;
      visitor->resize(large, large);
      m_client_mb = std::max(m_client_mb, clientMegabytes(visitor->pid()));
    }
  }
  void end() override {
    for (const auto& visitor : m_visitors) m_ended += visitor->hasExited() ? 1 : 0;
    m_visitors.clear();
  }
  void addFigures(Figures& figures) override {
    const bool is_large = m_client_mb == 0 || m_client_mb > 64;
    figures.push_back({"client_mb", static_cast<double>(m_client_mb), is_large});
    figures.push_back({"clients_ended", static_cast<double>(m_ended)});
  }

 private:
  static constexpr int kVisitors = 4;

  /// Returns the resident memory of the door's client; 0 if it has none.
  static long long clientMegabytes(pid_t door) {
    const std::string of_door = std::to_string(door);
    std::istringstream children(contentOf("/proc/" + of_door + "/task/" + of_door + "/children"));
    std::string client;
    if (!(children >> client)) return 0;
    std::istringstream lines(contentOf("/proc/" + client + "/status"));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("VmRSS:")) return std::stoll(line.substr(6)) / 1024;
    return 0;
  }

  TempFolder m_folder;
  std::vector<std::unique_ptr<PtyTerminal>> m_visitors;
  Time m_next{};
  int m_resizes = 0;
  long long m_client_mb = 0;
  long long m_ended = 0;
};

/// A member of the bus that sends 20,000 messages a second. Counts how often the list of servers lacks the
/// one with the players.
class BusFlood : public Attack {
 public:
  BusFlood() {
    if (!m_bus.start()) throw std::runtime_error("nats-server does not start");
    m_directory.emplace(startLogged({NAIAD_BINARY_DIR "/dfdir", "--bus", m_bus.url(), "--list", list(),
                                     "--listen", "127.0.0.1:0", "--identity", m_folder / "identity"},
                                    m_folder / "directory.log"));
  }

  ServerSetup setup() const override {
    return {.arguments = {"--bus", m_bus.url(), "--bus-id", "honest", "--public-host", "127.0.0.1"},
            .password = {}};
  }
  std::chrono::seconds leadTime() const override { return 5s; }  // the server must be in the list
  void begin(const Target& target) override {
    m_socket.emplace(target.context);
    const std::string url = m_bus.url();
    const int port = std::stoi(url.substr(url.rfind(':') + 1));
    m_socket->connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
    asio::write(*m_socket, asio::buffer(std::string("CONNECT {\"verbose\":false}\r\n")));
    m_socket->non_blocking(true);
    m_listed_at = Clock::now() + leadTime();
    for (int i = 0; i < kBatch; ++i) m_batch += "PUB naiad.presence.flood 2\r\n{}\r\n";
  }
  void update(Time now) override {
    if (now >= m_next) {
      m_next += m_next == Time{} ? now.time_since_epoch() : kBetweenBatches;
      if (m_unsent.empty()) {
        m_unsent = m_batch;
        m_messages += kBatch;
      }
    }
    asio::error_code error;
    m_unsent.erase(0, m_socket->write_some(asio::buffer(m_unsent), error));
    std::array<char, 4096> pings;
    if (m_socket->read_some(asio::buffer(pings), error) > 0) m_unsent += "PONG\r\n";
    if (now < m_look_at) return;
    m_look_at = now + 250ms;
    if (now >= m_listed_at)
      ++(contentOf(list()).find("\"link\"") != std::string::npos ? m_listed : m_unlisted);
  }
  void end() override { m_socket.reset(); }
  void addFigures(Figures& figures) override {
    figures.push_back({"messages", static_cast<double>(m_messages)});
    figures.push_back({"listed", static_cast<double>(m_listed)});
    figures.push_back({"unlisted", static_cast<double>(m_unlisted), m_unlisted > 0 || m_listed == 0});
  }

 private:
  static constexpr int kBatch = 400;
  static constexpr std::chrono::milliseconds kBetweenBatches{20};

  std::string list() const { return m_folder / "servers.json"; }

  TempFolder m_folder;
  naiad::test::NatsServer m_bus;
  std::optional<Process> m_directory;
  std::optional<asio::ip::tcp::socket> m_socket;
  std::string m_batch;
  std::string m_unsent;
  Time m_next{};
  Time m_look_at{};
  Time m_listed_at{};
  long long m_messages = 0;
  long long m_listed = 0;    // looks at the list that found the server
  long long m_unlisted = 0;  // and that did not
};

}  // namespace bench::attack
