#include "client/lan/ServerListJson.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

using nlohmann::json;

constexpr int kMaxDepth = 8;

std::string textAt(const json& object, const char* p_name) {
  const auto found = object.find(p_name);
  return found != object.end() && found->is_string()
             ? safeText(found->get_ref<const std::string&>(), kMaxLanText)
             : "";
}

std::uint16_t countAt(const json& object, const char* p_name, std::uint16_t missing = 0) {
  const auto found = object.find(p_name);
  if (found == object.end()) return missing;
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return found->is_number() ? static_cast<std::uint16_t>(std::clamp(found->get<double>(), 0.0, kMost)) : 0;
}

/// Nothing without a link that leads somewhere.
std::optional<FoundServer> serverOf(const json& object) {
  const auto text = object.find("link");
  if (text == object.end() || !text->is_string()) return std::nullopt;
  const auto parsed = JoinLink::parse(text->get_ref<const std::string&>());
  const auto* p_link = std::get_if<JoinLink>(&parsed);
  if (p_link == nullptr || !p_link->room.empty()) return std::nullopt;
  FoundServer server;
  server.name = textAt(object, "name");
  server.game = textAt(object, "game");
  server.players = countAt(object, "players");
  server.max_players = countAt(object, "max_players");
  server.protocol = countAt(object, "protocol", kProtocolVersion);
  const auto password = object.find("password");
  server.asks_password = password != object.end() && *password == true;
  server.where = {p_link->where.host, p_link->where.port};
  server.key = p_link->key;
  return server;
}

}  // namespace

std::optional<FoundServers> readServerList(std::string_view text) {
  bool too_deep = false;
  const auto judge = [&too_deep](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kMaxDepth;
    return !too_deep;
  };
  json list = json::parse(text, judge, false);
  if (too_deep || list.is_discarded()) return std::nullopt;
  if (list.is_object()) list = json::array({std::move(list)});
  FoundServers servers;
  if (!list.is_array()) return std::nullopt;
  for (const json& object : list) {
    if (!object.is_object()) return std::nullopt;
    if (const auto server = serverOf(object)) servers.addServer(*server);
  }
  return servers;
}

}  // namespace naiad
