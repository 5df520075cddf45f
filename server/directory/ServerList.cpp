#include "server/directory/ServerList.h"

#include <algorithm>

#include "shared/net/base/JsonText.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

std::uint32_t freePlaces(const Presence& server) {
  return server.max_players - std::min(server.players, server.max_players);
}

std::string rowOf(const Presence& server) {
  const std::string& name = server.name.empty() ? server.id : server.name;
  return "{\"name\": " + jsonQuoted(safeText(name, Presence::kMaxName)) +
         ", \"game\": " + jsonQuoted(safeText(server.game, Presence::kMaxName)) +
         ", \"players\": " + std::to_string(server.players) +
         ", \"max_players\": " + std::to_string(server.max_players) +
         ", \"password\": " + (server.asks_password ? "true" : "false") +
         ", \"protocol\": " + std::to_string(server.protocol) + ", \"link\": " + jsonQuoted(linkOf(server)) +
         "}";
}

}  // namespace

std::string linkOf(const Presence& server) {
  const auto key = Fingerprint::parse(server.key);
  if (!key || server.host.empty()) return "";
  return JoinLink{{server.host, server.port}, "", ShortKey::of(*key)}.text();
}

std::string serverListText(std::vector<Presence> servers) {
  std::erase_if(servers, [](const Presence& one) { return !one.is_open || linkOf(one).empty(); });
  std::stable_sort(servers.begin(), servers.end(),
                   [](const Presence& a, const Presence& b) { return freePlaces(a) > freePlaces(b); });
  if (servers.size() > kMaxListedServers) servers.resize(kMaxListedServers);
  std::string text = "[";
  for (const Presence& server : servers) text += (text.size() > 1 ? ",\n" : "\n") + rowOf(server);
  return text + "\n]\n";
}

}  // namespace naiad
