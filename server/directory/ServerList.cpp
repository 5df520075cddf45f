#include "server/directory/ServerList.h"

#include <algorithm>

#include "shared/json/Json.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

/// Servers behind so much are listed without their rooms: clients read 1 MiB (ListDownload.h).
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

}  // namespace naiad
