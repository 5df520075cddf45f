#include "client/lan/ServerListJson.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "shared/json/Json.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

constexpr std::size_t kMaxDepth = 8;

std::uint16_t countAt(const Json& server, std::string_view name, std::uint16_t missing = 0) {
  const Json* const p_value = server.find(name);
  if (p_value == nullptr) return missing;
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return static_cast<std::uint16_t>(std::clamp(p_value->number().value_or(0), 0.0, kMost));
}

/// Nothing without a link that leads somewhere.
std::optional<FoundServer> serverOf(const Json& object) {
  const auto parsed = JoinLink::parse(object["link"].textOrEmpty());
  const auto* p_link = std::get_if<JoinLink>(&parsed);
  if (p_link == nullptr || !p_link->room.empty()) return std::nullopt;
  FoundServer server;
  server.name = safeText(object["name"].textOrEmpty(), kMaxLanText);
  server.game = safeText(object["game"].textOrEmpty(), kMaxLanText);
  server.players = countAt(object, "players");
  server.max_players = countAt(object, "max_players");
  server.protocol = countAt(object, "protocol", kProtocolVersion);
  const bool* const p_password = object["password"].boolean();
  server.asks_password = p_password != nullptr && *p_password;
  server.where = {p_link->where.host, p_link->where.port};
  server.key = p_link->key;
  return server;
}

}  // namespace

std::optional<FoundServers> readServerList(std::string_view text) {
  auto list = Json::parse(text, kMaxDepth, Json::Duplicates::kKeepLast);
  if (list && list->object() != nullptr) list = Json::Array{*list};
  if (!list || list->array() == nullptr) return std::nullopt;
  FoundServers servers;
  for (const Json& object : *list->array()) {
    if (object.object() == nullptr) return std::nullopt;
    if (const auto server = serverOf(object)) servers.addServer(*server);
  }
  return servers;
}

}  // namespace naiad
