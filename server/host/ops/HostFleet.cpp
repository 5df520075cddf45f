#include "host/ops/HostFleet.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "host/fleet/AgonesPlatform.h"
#include "host/fleet/HostPlatform.h"
#include "host/fleet/ServiceNotify.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/rooms/HostContext.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

constexpr std::chrono::seconds kSayPlayers{1};
constexpr std::chrono::milliseconds kFinishTimeout{1500};  ///< limit for the bus, and again for the platform

BusSettings busSettings(const HostOptions& options) {
  return {options.bus, options.bus_credentials, options.bus_ca};
}

/// Returns --platform; for "auto", detects the platform by the variable that it sets for its processes.
std::string platformOf(const HostOptions& options) {
  if (options.platform != "auto") return options.platform;
  if (std::getenv("AGONES_SDK_HTTP_PORT") != nullptr) return "agones";
  return std::getenv("NOTIFY_SOCKET") != nullptr ? "systemd" : "none";
}

std::unique_ptr<HostPlatform> makePlatform(const HostOptions& options) {
  const std::string platform = platformOf(options);
  if (platform == "agones") return std::make_unique<AgonesPlatform>(0);
  if (platform == "systemd") return std::make_unique<ServiceNotify>();
  return std::make_unique<HostPlatform>();
}

/// Returns --bus-id, or an id made of the machine's name and the port.
std::string busId(const HostOptions& options, std::uint16_t port) {
  if (!options.bus_id.empty()) return options.bus_id;
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  return serverIdOf(std::string(host).substr(0, kMaxServerId - 6) + "-" + std::to_string(port));
}

/// Returns the named rooms of a server, if it has any.
std::vector<PresenceRoom> presenceOfRooms(const RoomManager& rooms) {
  std::vector<PresenceRoom> all;
  if (!rooms.isNamed()) return all;
  rooms.forEachRoom([&all](const Room& room) {
    const RoomConfig& plan = *room.plan();
    all.push_back({plan.name, plan.game, static_cast<std::uint32_t>(room.countPlaying()),
                   static_cast<std::uint32_t>(plan.max_players)});
  });
  return all;
}

}  // namespace

HostFleet::HostFleet(const HostAccess& access, HostScores& scores)
    : m_access(access), m_platform(makePlatform(access.context.options)) {
  access.controls.setOnReload([this](bool is_done, Clock::time_point now) {
    is_done ? m_platform->notifyReady() : m_platform->notifyReloading(now);
  });
  access.controls.setOnForcedExit([this](std::chrono::milliseconds timeout) { m_platform->finish(timeout); });
  if (access.context.options.bus.empty()) return;
  m_id = busId(access.context.options, access.endpoint.port());
  BusSettings settings = busSettings(access.context.options);
  settings.subjects = {redirectSubject(m_id), formerRedirectSubject(m_id)};
  m_bus = connectBus(settings);
  access.clients.admission().setFindRedirect([this] { return redirectLink(); });
  scores.setObserver([this](const ScoreRow& row, const std::string& game) { publishScore(row, game); });
}

HostFleet::~HostFleet() = default;

void HostFleet::begin() {
  m_platform->notifyReady();
}

void HostFleet::tick(Clock::time_point now) {
  m_platform->notifyTick(now);
  if (m_bus && now - m_presence_sent_at >= interval()) {
    m_presence_sent_at = now;
    m_bus->publish({presenceSubject(m_id), presence().payload()});
    processRedirects(now);
  }
  if (now - m_players_reported_at < kSayPlayers) return;
  m_players_reported_at = now;
  reportPlayers();
  if (m_platform->popShutdownRequest()) {
    m_access.context.log("the platform requested a shutdown");
    m_access.controls.endWhenEmpty(m_access.context.options.drain_time);
  }
  processRedirects(now);
  popLogMessage();
}

// Stores the directory's newest valid redirect. An earlier one expires by itself (redirectLink()).
void HostFleet::processRedirects(Clock::time_point now) {
  if (!m_bus) return;
  for (const BusMessage& message : m_bus->popMessages()) {
    auto other = Redirect::parse(message.payload);
    if (!other || other->to == m_id) continue;
    m_redirect = *std::move(other);
    m_redirect_received_at = now;
  }
}

std::optional<JoinLink> HostFleet::redirectLink() const {
  const bool holds = m_redirect && Clock::now() - m_redirect_received_at < 3 * interval();
  return holds ? std::optional(m_redirect->link) : std::nullopt;
}

void HostFleet::reportPlayers() {
  PlatformPlayers players;
  players.address = m_access.endpoint.address();
  players.most = static_cast<std::size_t>(m_access.context.options.max_players);
  m_access.clients.sessions().forEachPlaying(
      [&](const Session& session) { players.ids.push_back(session.player()); });
  std::sort(players.ids.begin(), players.ids.end());
  m_platform->notifyPlayers(players);
}

Presence HostFleet::presence() const {
  const HostOptions& options = m_access.context.options;
  const std::uint16_t port = m_access.endpoint.port();
  const auto link = options.link_host.empty() ? std::nullopt : LinkHost::parse(options.link_host, port);
  Presence presence{m_access.clients.facts()};
  presence.id = m_id;
  presence.name = safeText(presence.name, Presence::kMaxName);
  presence.game = safeText(presence.game, Presence::kMaxName);
  const auto given = m_platform->address();
  presence.host = link ? link->host : given ? given->host : "";
  presence.port = link ? link->port : given ? given->port : port;
  const auto key = m_access.endpoint.fingerprint();
  presence.key = key ? key->text() : "";
  presence.is_open = m_access.context.shutdown_scheduler.acceptsPlayers();
  presence.rooms = presenceOfRooms(m_access.clients.rooms());
  return presence;
}

void HostFleet::publishScore(const ScoreRow& row, const std::string& game) {
  GameResult result;
  result.server = m_id;
  result.game = safeText(game, Presence::kMaxName);
  result.table = row.table;
  result.name = row.name;
  result.points = row.points;
  result.at = row.at;
  result.round = row.round;
  result.tick = row.tick;
  result.number = row.number;
  result.recording = row.recording;
  m_bus->publish({resultSubject(m_id), result.payload(), result.messageId()});
}

void HostFleet::popLogMessage() {
  if (const std::string news = m_platform->popLogMessage(); !news.empty())
    m_access.context.log(workerLogEvent(news));
  const PlatformCounters platform = m_platform->counters();
  m_access.context.counters.platform_requests = platform.requests;
  m_access.context.counters.platform_failures = platform.failures;
  if (!m_bus) return;
  if (const std::string news = m_bus->popLogMessage(); !news.empty())
    m_access.context.log(workerLogEvent(news));
  const BusCounters bus = m_bus->counters();
  m_access.context.counters.bus_published = bus.published;
  m_access.context.counters.bus_dropped = bus.dropped;
  m_access.context.counters.bus_failures = bus.failures;
  m_access.context.counters.bus_connections = bus.connections;
  m_access.context.counters.bus_lost = bus.lost;
}

void HostFleet::drain() {
  m_platform->notifyStopping();
  if (!m_bus) return;
  Presence last = presence();
  last.is_open = false;
  m_bus->publish({presenceSubject(m_id), last.payload()});
}

// Finishes with the platform last, because it may remove the server as soon as it is told of the end.
void HostFleet::finish() {
  if (m_bus) m_bus->finish(kFinishTimeout);
  m_platform->finish(kFinishTimeout);
  popLogMessage();
}

}  // namespace naiad
