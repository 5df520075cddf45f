#include "server/directory/ServerList.h"

#include <algorithm>

#include "shared/net/base/JsonText.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

/// Servers behind so much are listed without their rooms: clients read 1 MiB (ListDownload.h).
constexpr std::size_t kMaxTextWithRooms = 500'000;

std::uint32_t freePlaces(const Presence& server) {
  return server.max_players - std::min(server.players, server.max_players);
}

std::string roomsOf(const Presence& server) {
  std::string text;
  for (const PresenceRoom& room : server.rooms) {
    text += std::string(text.empty() ? "" : ", ") + "{\"name\": " + jsonQuoted(room.name) +
            ", \"game\": " + jsonQuoted(room.game) + ", \"players\": " + std::to_string(room.players) +
            ", \"max_players\": " + std::to_string(room.max_players) + "}";
  }
  return text;
}

std::string rowOf(const Presence& server, bool with_rooms) {
  const std::string& name = server.name.empty() ? server.id : server.name;
  return "{\"name\": " + jsonQuoted(safeText(name, Presence::kMaxName)) +
         ", \"game\": " + jsonQuoted(safeText(server.game, Presence::kMaxName)) +
         ", \"players\": " + std::to_string(server.players) +
         ", \"max_players\": " + std::to_string(server.max_players) +
         ", \"password\": " + (server.asks_password ? "true" : "false") +
         ", \"protocol\": " + std::to_string(server.protocol) + ", \"link\": " + jsonQuoted(linkOf(server)) +
         (with_rooms && !server.rooms.empty() ? ", \"rooms\": [" + roomsOf(server) + "]" : "") + "}";
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
