#include "server/directory/FleetRegistry.h"

#include <utility>

#include "shared/json/Json.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

/// After this many bytes, servers are listed without their rooms, because clients read at most 1 MiB
/// (ListDownload.h).
constexpr std::size_t kMaxTextWithRooms = 500'000;

std::uint32_t freePlaces(const Presence& server) {
  return server.max_players - std::min(server.players, server.max_players);
}

std::string rowOf(const Presence& server, bool with_rooms) {
  auto facts = static_cast<const ServerInfo&>(server);
  if (facts.name.empty()) facts.name = server.id;
  Json row = jsonOf(facts);
  row.set("link", linkOf(server));
  Json::Array rooms;
  for (const auto& [name, game, players, max_players] : server.rooms)
    rooms.push_back({{"name", name}, {"game", game}, {"players", players}, {"max_players", max_players}});
  if (with_rooms && !rooms.empty()) row.set("rooms", std::move(rooms));
  return row.toString(Json::Style::kAscii);
}

bool fitsRequest(const PresenceRoom& room, const FleetRegistry::PlayerRequest& request) {
  return (request.room.empty() || room.name == request.room) &&
         (request.game.empty() || room.game == request.game);
}

}  // namespace

std::string linkOf(const Presence& server, const std::string& room) {
  const auto key = Fingerprint::parse(server.key);
  if (!key || server.host.empty()) return "";
  return JoinLink{{server.host, server.port}, room, ShortKey::of(*key)}.text();
}

std::string serverListText(std::vector<Presence> servers) {
  std::erase_if(servers, [](const Presence& one) { return !one.is_open || linkOf(one).empty(); });
  std::stable_sort(servers.begin(), servers.end(),
                   [](const Presence& a, const Presence& b) { return freePlaces(a) > freePlaces(b); });
  if (servers.size() > kMaxListedServers) servers.resize(kMaxListedServers);
  std::string text = "[";
  for (const Presence& server : servers)
    text += (text.size() > 1 ? ",\n" : "\n") + rowOf(server, text.size() < kMaxTextWithRooms);
  return text + "\n]\n";
}

FleetMonitor::FleetMonitor(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log,
                           std::chrono::milliseconds interval)
    : m_bus(std::move(bus)), m_log(std::move(log)), m_interval(interval), m_servers(interval) {}

void FleetMonitor::update(Time now) {
  if (const std::string line = m_bus->popLogMessage(); !line.empty()) m_log(line);
  for (const BusMessage& message : m_bus->popMessages()) {
    if (m_servers.handleHeartbeat(message.subject, message.payload, now))
      logLimited(message.subject.substr(presenceSubject("").size()) + " joined the fleet", now);
  }
  const std::uint64_t lost = m_bus->counters().lost;
  const bool has_lost = std::exchange(m_lost, lost) != lost;
  const bool was_paused = now - std::exchange(m_updated, now) > m_interval;
  if (!m_bus->isConnected())
    m_servers.excuseSilence(now, kMaxBusOutage);
  else if (has_lost || was_paused)
    m_servers.excuseSilence(now, kMaxBusLoss);
  for (const std::string& id : m_servers.removeExpired(now)) logLimited(id + " left the fleet", now);
}

void FleetMonitor::logLimited(const std::string& line, Time now) {
  if (!m_log_limit.tryConsume(kLogRate, now)) {
    ++m_dropped_lines;
    return;
  }
  if (const auto count = std::exchange(m_dropped_lines, 0); count > 0)
    m_log(std::to_string(count) + " more servers joined or left");
  m_log(line);
}

bool FleetRegistry::handleHeartbeat(const std::string& subject, std::string_view payload, Time now) {
  auto presence = Presence::parse(payload);
  if (!presence) {
    ++m_counters.unreadable;
    return false;
  }
  if (presenceSubject(presence->id) != subject) {
    ++m_counters.wrong_subject;
    return false;
  }
  const bool is_new = m_servers.count(presence->id) == 0;
  if (is_new && m_servers.size() >= kMaxServers) {
    ++m_counters.over_limit;
    return false;
  }
  ++m_counters.heartbeats;
  RegisteredServer& entry = m_servers[presence->id];
  entry.presence = *std::move(presence);
  entry.heard = now;
  entry.sent = {0, entry.sent[0], entry.sent[1]};
  std::map<std::string, RedirectCounts> sent_to;
  for (const PresenceRoom& room : entry.presence.rooms) {
    if (const auto found = entry.sent_to.find(room.name); found != entry.sent_to.end())
      sent_to[room.name] = {0, found->second[0], found->second[1]};
  }
  entry.sent_to = std::move(sent_to);
  return is_new;
}

std::vector<std::string> FleetRegistry::removeExpired(Time now) {
  std::vector<std::string> gone;
  for (auto at = m_servers.begin(); at != m_servers.end();) {
    if (now - std::max(at->second.heard, at->second.excused) < m_timeout) {
      ++at;
      continue;
    }
    gone.push_back(at->first);
    at = m_servers.erase(at);
  }
  m_counters.expired += gone.size();
  return gone;
}

void FleetRegistry::excuseSilence(Time now, std::chrono::minutes most) {
  for (auto& [id, entry] : m_servers) {
    if (now - entry.heard < most) entry.excused = now;
  }
}

bool FleetRegistry::Load::isBetterThan(const Load& other) const {
  if (isBelowThreeQuarters() != other.isBelowThreeQuarters()) return isBelowThreeQuarters();
  return isBelowThreeQuarters() ? taken > other.taken : free() > other.free();
}

FleetRegistry::Load FleetRegistry::RegisteredServer::load() const {
  return {presence.players + sent[0] + sent[1] + sent[2], presence.max_players};
}

FleetRegistry::Load FleetRegistry::RegisteredServer::load(const PresenceRoom& room) const {
  const auto found = sent_to.find(room.name);
  const RedirectCounts on_the_way = found != sent_to.end() ? found->second : RedirectCounts();
  return {room.players + on_the_way[0] + on_the_way[1] + on_the_way[2], room.max_players};
}

bool FleetRegistry::fits(const RegisteredServer& entry, const PlayerRequest& request) {
  const Presence& there = entry.presence;
  const bool may = !there.requires_password && !there.host.empty() && !there.key.empty() &&
                   there.port >= kMinFleetPort && there.protocol == request.protocol &&
                   there.id != request.not_id;
  if (!may) return false;
  if (!there.rooms.empty())
    return std::ranges::any_of(there.rooms,
                               [&request](const auto& room) { return fitsRequest(room, request); });
  return request.room.empty() && (request.game.empty() || there.game == request.game);
}

// Looks at the rooms in the server's order, so without a request the first room with a free place is chosen.
const PresenceRoom* FleetRegistry::findRoom(const RegisteredServer& entry, const PlayerRequest& request) {
  const PresenceRoom* p_best = nullptr;
  for (const PresenceRoom& room : entry.presence.rooms) {
    if (!fitsRequest(room, request) || entry.load(room).free() == 0) continue;
    if (p_best == nullptr || (!request.game.empty() && entry.load(room).isBetterThan(entry.load(*p_best))))
      p_best = &room;
  }
  return p_best;
}

std::optional<FleetRegistry::Load> FleetRegistry::loadFor(const RegisteredServer& entry,
                                                          const PlayerRequest& request) {
  if (!fits(entry, request) || !entry.presence.is_open || entry.load().free() == 0) return std::nullopt;
  if (entry.presence.rooms.empty()) return entry.load();
  const PresenceRoom* const p_room = findRoom(entry, request);
  if (p_room == nullptr) return std::nullopt;
  return request.game.empty() && request.room.empty() ? entry.load() : entry.load(*p_room);
}

FleetRegistry::Assignment FleetRegistry::assignmentOn(const RegisteredServer& entry,
                                                      const PlayerRequest& request) {
  const PresenceRoom* const p_room = findRoom(entry, request);
  return {&entry.presence, p_room != nullptr ? p_room->name : ""};
}

FleetRegistry::Assignment FleetRegistry::choose(const PlayerRequest& request) {
  RegisteredServer* p_best = nullptr;
  std::optional<Load> best;
  for (auto& [id, entry] : m_servers) {
    const auto load = loadFor(entry, request);
    if (!load || (best && !load->isBetterThan(*best))) continue;
    p_best = &entry;
    best = load;
  }
  if (p_best == nullptr) return {};
  Assignment place = assignmentOn(*p_best, request);
  ++p_best->sent[0];
  if (!place.room.empty()) ++p_best->sent_to[place.room][0];
  return place;
}

FleetRegistry::Assignment FleetRegistry::leastLoaded(const PlayerRequest& request) const {
  const RegisteredServer* p_best = nullptr;
  std::uint32_t most = 0;
  for (const auto& [id, entry] : m_servers) {
    const auto load = loadFor(entry, request);
    const std::uint32_t free = load ? std::min(load->free(), entry.load().free()) : 0;
    if (free <= most) continue;
    p_best = &entry;
    most = free;
  }
  return p_best != nullptr ? assignmentOn(*p_best, request) : Assignment();
}

bool FleetRegistry::hasMatch(const PlayerRequest& request) const {
  return std::any_of(m_servers.begin(), m_servers.end(),
                     [&request](const auto& one) { return fits(one.second, request); });
}

std::vector<Presence> FleetRegistry::nearlyFull() const {
  std::vector<Presence> found;
  for (const auto& [id, entry] : m_servers) {
    if (!entry.presence.is_open || !entry.load().isBelowThreeQuarters()) found.push_back(entry.presence);
  }
  return found;
}

std::vector<Presence> FleetRegistry::servers() const {
  std::vector<Presence> all;
  all.reserve(m_servers.size());
  for (const auto& [id, entry] : m_servers) all.push_back(entry.presence);
  return all;
}

}  // namespace naiad
