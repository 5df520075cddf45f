#include "server/directory/FleetList.h"

#include <utility>

#include "shared/json/Json.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

/// After this many bytes, servers are listed without their rooms: clients read 1 MiB (ListDownload.h).
constexpr std::size_t kMaxTextWithRooms = 500'000;

std::uint32_t freePlaces(const Presence& server) {
  return server.max_players - std::min(server.players, server.max_players);
}

std::string rowOf(const Presence& server, bool with_rooms) {
  auto facts = static_cast<const ServerFacts&>(server);
  if (facts.name.empty()) facts.name = server.id;
  Json row = jsonOf(facts);
  row.set("link", linkOf(server));
  Json::Array rooms;
  for (const auto& [name, game, players, max_players] : server.rooms)
    rooms.push_back({{"name", name}, {"game", game}, {"players", players}, {"max_players", max_players}});
  if (with_rooms && !rooms.empty()) row.set("rooms", std::move(rooms));
  return row.toString(Json::Style::kAscii);
}

bool isWished(const PresenceRoom& room, const FleetList::Wish& wish) {
  return (wish.room.empty() || room.name == wish.room) && (wish.game.empty() || room.game == wish.game);
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

FleetWatch::FleetWatch(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log, Time now,
                       std::chrono::milliseconds interval)
    : m_bus(std::move(bus)), m_log(std::move(log)), m_servers(interval), m_connected_at(now) {}

void FleetWatch::update(Time now) {
  if (const std::string line = m_bus->takeNews(); !line.empty()) m_log(line);
  for (const BusMessage& message : m_bus->takeMessages()) {
    if (m_servers.put(message.subject, message.payload, now))
      logNews(message.subject.substr(presenceSubject("").size()) + " joined the fleet", now);
  }
  if (m_bus->isConnected()) m_connected_at = now;
  // No heartbeats arrive without the bus, so no server expires unless the bus is down longer than kBlind.
  const bool is_blind = m_connected_at != now;
  if (is_blind && now - m_connected_at < kBlind) return m_servers.forgiveSilence(now);
  for (const std::string& id : m_servers.removeSilent(now)) logNews(id + " left the fleet", now);
}

void FleetWatch::logNews(const std::string& line, Time now) {
  if (!m_news.takeToken(kNewsRate, now)) {
    ++m_news_left_out;
    return;
  }
  if (const auto count = std::exchange(m_news_left_out, 0); count > 0)
    m_log(std::to_string(count) + " more servers joined or left");
  m_log(line);
}

bool FleetList::put(const std::string& subject, std::string_view payload, Time now) {
  auto presence = Presence::parse(payload);
  if (!presence) {
    ++m_counters.unreadable;
    return false;
  }
  if (presenceSubject(presence->id) != subject) {
    ++m_counters.foreign;
    return false;
  }
  const bool is_new = m_servers.count(presence->id) == 0;
  if (is_new && m_servers.size() >= kMaxServers) {
    ++m_counters.crowded;
    return false;
  }
  ++m_counters.heard;
  Entry& entry = m_servers[presence->id];
  entry.presence = *std::move(presence);
  entry.heard = now;
  entry.sent = {0, entry.sent[0], entry.sent[1]};
  std::map<std::string, Sent> sent_to;
  for (const PresenceRoom& room : entry.presence.rooms) {
    if (const auto found = entry.sent_to.find(room.name); found != entry.sent_to.end())
      sent_to[room.name] = {0, found->second[0], found->second[1]};
  }
  entry.sent_to = std::move(sent_to);
  return is_new;
}

std::vector<std::string> FleetList::removeSilent(Time now) {
  std::vector<std::string> gone;
  for (auto at = m_servers.begin(); at != m_servers.end();) {
    if (now - at->second.heard < m_life) {
      ++at;
      continue;
    }
    gone.push_back(at->first);
    at = m_servers.erase(at);
  }
  m_counters.expired += gone.size();
  return gone;
}

void FleetList::forgiveSilence(Time now) {
  for (auto& [id, entry] : m_servers) entry.heard = now;
}

bool FleetList::Load::isBetterThan(const Load& other) const {
  if (isCalm() != other.isCalm()) return isCalm();
  return isCalm() ? taken > other.taken : free() > other.free();
}

FleetList::Load FleetList::Entry::load() const {
  return {presence.players + sent[0] + sent[1] + sent[2], presence.max_players};
}

FleetList::Load FleetList::Entry::load(const PresenceRoom& room) const {
  const auto found = sent_to.find(room.name);
  const Sent on_the_way = found != sent_to.end() ? found->second : Sent();
  return {room.players + on_the_way[0] + on_the_way[1] + on_the_way[2], room.max_players};
}

bool FleetList::isOfKind(const Entry& entry, const Wish& wish) {
  const Presence& there = entry.presence;
  const bool may = !there.asks_password && !there.host.empty() && !there.key.empty() &&
                   there.port >= kLeastFleetPort && there.protocol == wish.protocol &&
                   there.id != wish.not_id;
  if (!may) return false;
  if (!there.rooms.empty())
    return std::ranges::any_of(there.rooms, [&wish](const auto& room) { return isWished(room, wish); });
  return wish.room.empty() && (wish.game.empty() || there.game == wish.game);
}

// Rooms are in the server's order. Without a wish, the first one with a free place is chosen.
const PresenceRoom* FleetList::findRoom(const Entry& entry, const Wish& wish) {
  const PresenceRoom* p_best = nullptr;
  for (const PresenceRoom& room : entry.presence.rooms) {
    if (!isWished(room, wish) || entry.load(room).free() == 0) continue;
    if (p_best == nullptr || (!wish.game.empty() && entry.load(room).isBetterThan(entry.load(*p_best))))
      p_best = &room;
  }
  return p_best;
}

std::optional<FleetList::Load> FleetList::loadFor(const Entry& entry, const Wish& wish) {
  if (!isOfKind(entry, wish) || !entry.presence.is_open || entry.load().free() == 0) return std::nullopt;
  if (entry.presence.rooms.empty()) return entry.load();
  const PresenceRoom* const p_room = findRoom(entry, wish);
  if (p_room == nullptr) return std::nullopt;
  return wish.game.empty() && wish.room.empty() ? entry.load() : entry.load(*p_room);
}

FleetList::Place FleetList::placeIn(const Entry& entry, const Wish& wish) {
  const PresenceRoom* const p_room = findRoom(entry, wish);
  return {&entry.presence, p_room != nullptr ? p_room->name : ""};
}

FleetList::Place FleetList::choose(const Wish& wish) {
  Entry* p_best = nullptr;
  std::optional<Load> best;
  for (auto& [id, entry] : m_servers) {
    const auto load = loadFor(entry, wish);
    if (!load || (best && !load->isBetterThan(*best))) continue;
    p_best = &entry;
    best = load;
  }
  if (p_best == nullptr) return {};
  Place place = placeIn(*p_best, wish);
  ++p_best->sent[0];
  if (!place.room.empty()) ++p_best->sent_to[place.room][0];
  return place;
}

FleetList::Place FleetList::roomiest(const Wish& wish) const {
  const Entry* p_best = nullptr;
  std::uint32_t most = 0;
  for (const auto& [id, entry] : m_servers) {
    const auto load = loadFor(entry, wish);
    const std::uint32_t free = load ? std::min(load->free(), entry.load().free()) : 0;
    if (free <= most) continue;
    p_best = &entry;
    most = free;
  }
  return p_best != nullptr ? placeIn(*p_best, wish) : Place();
}

bool FleetList::plays(const Wish& wish) const {
  return std::any_of(m_servers.begin(), m_servers.end(),
                     [&wish](const auto& one) { return isOfKind(one.second, wish); });
}

std::vector<Presence> FleetList::crowded() const {
  std::vector<Presence> found;
  for (const auto& [id, entry] : m_servers) {
    if (!entry.presence.is_open || !entry.load().isCalm()) found.push_back(entry.presence);
  }
  return found;
}

std::vector<Presence> FleetList::servers() const {
  std::vector<Presence> all;
  all.reserve(m_servers.size());
  for (const auto& [id, entry] : m_servers) all.push_back(entry.presence);
  return all;
}

}  // namespace naiad
