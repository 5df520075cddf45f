#include "server/directory/Directory.h"

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "host/auth/ServerIdentity.h"
#include "server/directory/FleetWatch.h"
#include "server/directory/ListFile.h"
#include "server/directory/ServerList.h"
#include "shared/fleet/SendOn.h"
#include "shared/fleet/ServerId.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMaxTurn{250};

/// Servers that come and go are seen soon, in each of their intervals a few times.
std::chrono::milliseconds turnOf(const DirectorySettings& settings) {
  return std::min(kMaxTurn, settings.interval / 4);
}

BusSettings listening(BusSettings settings) {
  settings.subjects = {presenceSubject("*")};
  return settings;
}

ServerIdentity identityOf(const DirectorySettings& settings) {
  if (!settings.certificate.empty()) return ServerIdentity::load(settings.certificate, settings.key);
  const std::filesystem::path folder = settings.identity.empty() ? ServerIdentity::defaultDirectory()
                                                                 : std::filesystem::path(settings.identity);
  return ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now());
}

}  // namespace

struct Directory::Loop {
  Loop(DirectorySettings given, LogLine line);

  void openLobby();
  void reload();
  void takeTurn(Clock::time_point now);
  void sendOn(Clock::time_point now);
  void awaitTurn();
  void heedSignals();
  void stop();
  void logCounters();

  DirectorySettings settings;
  LogLine log;
  asio::io_context context{1};
  asio::steady_timer timer{context};
  asio::signal_set signals{context};
  std::optional<ListFile> file;
  FleetWatch fleet;
  std::optional<ServerIdentity> identity;
  std::optional<Lobby> lobby;
  Clock::time_point said_room{};
};

Directory::Loop::Loop(DirectorySettings given, LogLine line)
    : settings(std::move(given)),
      log(std::move(line)),
      fleet(
          connectBus(listening(settings.bus)), [this](const std::string& text) { log(text); }, Clock::now(),
          settings.interval) {
  if (!settings.list.empty()) file.emplace(settings.list, serverListText({}));
  openLobby();
  awaitTurn();
}

void Directory::Loop::openLobby() {
  if (!settings.lobby) return;
  identity = identityOf(settings);
  lobby.emplace(context, *settings.lobby, identity->tls(), fleet.servers());
}

// With a key that cannot be read the old one stays.
void Directory::Loop::reload() {
  LineLog::reopenAll();
  if (!lobby) return;
  try {
    ServerIdentity read = identityOf(settings);
    if (read.fingerprint() != identity->fingerprint())
      log("the lobby has another key now: links to it lead nowhere");
    identity = std::move(read);
    lobby->setTls(identity->tls());
  } catch (const TlsError& error) {
    log({LogEvent::Level::kWarning,
         std::string("warning: the lobby keeps its certificate: ") + error.what()});
  }
}

void Directory::Loop::awaitTurn() {
  timer.expires_after(turnOf(settings));
  timer.async_wait([this](const std::error_code& error) {
    if (error) return;
    takeTurn(Clock::now());
    awaitTurn();
  });
}

void Directory::Loop::takeTurn(Clock::time_point now) {
  fleet.update(now);
  sendOn(now);
  if (!file) return;
  file->setText(serverListText(fleet.servers().servers()));
  if (const std::string line = file->takeNews(); !line.empty()) log(line);
}

/// Servers that fill up are said where there is room.
void Directory::Loop::sendOn(Clock::time_point now) {
  if (now - said_room < settings.interval) return;
  said_room = now;
  for (const Presence& full : fleet.servers().crowded()) {
    const FleetList::Place other = fleet.servers().roomiest({full.game, full.protocol, full.id});
    if (!other) continue;
    const auto link = JoinLink::parse(linkOf(*other.p_server, other.room));
    if (const auto* const p_link = std::get_if<JoinLink>(&link))
      fleet.bus().publish({sendOnSubject(full.id), SendOn{other.p_server->id, *p_link}.payload()});
  }
}

void Directory::Loop::heedSignals() {
  signals.add(SIGINT);
  signals.add(SIGTERM);
  signals.add(SIGHUP);
  signals.async_wait([this](const std::error_code& error, int signal) {
    if (error) return;
    if (signal != SIGHUP) return stop();
    reload();
    heedSignals();
  });
}

void Directory::Loop::stop() {
  signals.clear();
  timer.cancel();
  context.stop();
}

void Directory::Loop::logCounters() {
  const FleetCounters& counted = fleet.servers().counters();
  const BusCounters passed = fleet.bus().counters();
  std::vector<std::pair<const char*, std::uint64_t>> all = {{"heard", counted.heard},
                                                            {"unreadable", counted.unreadable},
                                                            {"foreign", counted.foreign},
                                                            {"crowded", counted.crowded},
                                                            {"expired", counted.expired},
                                                            {"bus_received", passed.received},
                                                            {"bus_ignored", passed.ignored},
                                                            {"bus_failures", passed.failures},
                                                            {"bus_connections", passed.connections}};
  if (lobby) {
    const LobbyCounters& met = lobby->counters();
    const TcpListener::Counters& streams = lobby->streams();
    all.insert(all.end(), {{"hellos", met.hellos},
                           {"sent_on", met.sent_on},
                           {"no_place", met.no_place},
                           {"no_game", met.no_game},
                           {"malformed", met.malformed},
                           {"late", met.late},
                           {"guests_crowded", met.crowded},
                           {"handshakes", streams.handshakes},
                           {"handshakes_failed", streams.handshakes_failed},
                           {"handshakes_late", streams.handshakes_late},
                           {"refused_too_often", streams.refused_too_often}});
  }
  std::string line = "counters:";
  for (const auto& [name, count] : all) {
    if (count > 0) line += std::string(" ") + name + "=" + std::to_string(count);
  }
  log(line);
}

Directory::Directory(DirectorySettings settings, LogLine log)
    : m_loop(std::make_unique<Loop>(std::move(settings), std::move(log))) {}

Directory::~Directory() = default;

void Directory::heedSignals() {
  m_loop->heedSignals();
}

void Directory::run() {
  m_loop->context.run();
  m_loop->logCounters();
}

void Directory::stop() {
  m_loop->stop();
}

std::optional<std::uint16_t> Directory::port() const {
  return m_loop->lobby ? std::optional(m_loop->lobby->port()) : std::nullopt;
}

std::optional<Fingerprint> Directory::fingerprint() const {
  return m_loop->identity ? std::optional(m_loop->identity->fingerprint()) : std::nullopt;
}

}  // namespace naiad
