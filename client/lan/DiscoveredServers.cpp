#include "client/lan/DiscoveredServers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

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

/// Returns the server of a list entry. Nullopt without a valid link, or if the link names a room.
std::optional<DiscoveredServer> serverOf(const Json& object) {
  const auto parsed = JoinLink::parse(object["link"].textOrEmpty());
  const auto* p_link = std::get_if<JoinLink>(&parsed);
  if (p_link == nullptr || !p_link->room.empty()) return std::nullopt;
  DiscoveredServer server;
  server.name = safeText(object["name"].textOrEmpty(), kMaxLanText);
  server.game = safeText(object["game"].textOrEmpty(), kMaxLanText);
  server.players = countAt(object, "players");
  server.max_players = countAt(object, "max_players");
  server.protocol = countAt(object, "protocol", kProtocolVersion);
  const bool* const p_password = object["password"].boolean();
  server.requires_password = p_password != nullptr && *p_password;
  server.address = {p_link->address.host, p_link->address.port};
  server.key = p_link->key;
  return server;
}

using Row = std::array<std::string, 5>;

Row rowOf(const DiscoveredServer& server) {
  const std::string link = server.link();
  return {server.name, server.game, occupancyText(server), restrictionsText(server),
          link.empty() ? server.address.text() : link};
}

Json jsonOf(const DiscoveredServer& server) {
  Json json = jsonOf(static_cast<const ServerInfo&>(server));
  json.set("address", server.address.text());
  json.set("key", server.key.text());
  json.set("link", server.link().empty() ? Json() : server.link());
  return json;
}

int rankOf(const asio::ip::address& address) {
  if (address.is_loopback()) return 3;
  if (address.is_v4()) return 0;
  return address.to_v6().scope_id() == 0 ? 1 : 2;
}

}  // namespace

std::optional<DiscoveredServers> readServerList(std::string_view text) {
  auto list = Json::parse(text, kMaxDepth, Json::Duplicates::kKeepLast);
  if (list && list->object() != nullptr) list = Json::Array{*list};
  if (!list || list->array() == nullptr) return std::nullopt;
  DiscoveredServers servers;
  for (const Json& object : *list->array()) {
    if (object.object() == nullptr) return std::nullopt;
    if (const auto server = serverOf(object)) servers.addServer(*server);
  }
  return servers;
}

std::string occupancyText(const DiscoveredServer& server) {
  return std::to_string(server.players) + "/" + std::to_string(server.max_players);
}

std::string restrictionsText(const DiscoveredServer& server) {
  if (!server.isPlayable()) return "version " + std::to_string(server.protocol);
  if (server.players >= server.max_players) return "full";
  return server.requires_password ? "password" : "";
}

std::string serversAsText(const std::vector<DiscoveredServer>& servers) {
  if (servers.empty()) {
    std::string text;
    for (const char* p_line : kNoServersFound) text += std::string(p_line) + "\n";
    return text;
  }
  std::vector<Row> rows{{"NAME", "GAME", "PLAYERS", "NOTE", "SERVER"}};
  for (const DiscoveredServer& server : servers) rows.push_back(rowOf(server));
  std::array<std::size_t, 5> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], columnsOf(row[i]));
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      text += row[i] + std::string(widths[i] - columnsOf(row[i]) + 2, ' ');
    text += row.back() + "\n";
  }
  return text;
}

std::string serversAsJson(const std::vector<DiscoveredServer>& servers) {
  std::string text = "[";
  for (const DiscoveredServer& server : servers)
    text += (text.size() > 1 ? ",\n " : "") + jsonOf(server).toString(Json::Style::kAscii);
  return text + "]\n";
}

bool DiscoveredServer::isPlayable() const {
  return protocol == kProtocolVersion;
}

std::string DiscoveredServer::link() const {
  const auto host = LinkHost::parse(address.text());
  return host ? JoinLink{*host, "", key}.text() : "";
}

bool DiscoveredServers::addAnswer(const asio::ip::udp::endpoint& source, const LanAnswer& answer) {
  const ServerInfo& facts = answer;
  const DiscoveredServer server{facts, {source.address().to_string(), answer.port}, answer.key};
  return addListed(server, rankOf(source.address()));
}

bool DiscoveredServers::addServer(const DiscoveredServer& server) {
  return addListed(server, 0);
}

bool DiscoveredServers::addListed(const DiscoveredServer& server, int rank) {
  const auto known = std::find_if(m_servers.begin(), m_servers.end(), [&server](const ListedServer& entry) {
    return entry.server.key == server.key;
  });
  if (known != m_servers.end()) {
    const bool same_place = known->server.address.text() == server.address.text();
    if (rank > known->rank || (rank == known->rank && !same_place) || known->server == server) return false;
    *known = {server, rank};
    return true;
  }
  const auto here = std::count_if(m_servers.begin(), m_servers.end(), [&server](const ListedServer& entry) {
    return entry.server.address.host == server.address.host;
  });
  if (m_servers.size() >= kMax || static_cast<std::size_t>(here) >= kMaxPerAddress) return false;
  m_servers.push_back({server, rank});
  return true;
}

std::vector<DiscoveredServer> DiscoveredServers::sorted() const {
  std::vector<DiscoveredServer> servers;
  for (const ListedServer& entry : m_servers) servers.push_back(entry.server);
  const auto order = [](const DiscoveredServer& server) {
    return std::make_tuple(server.name, server.game, server.key.bytes());
  };
  std::sort(servers.begin(), servers.end(),
            [&order](const DiscoveredServer& a, const DiscoveredServer& b) { return order(a) < order(b); });
  return servers;
}

}  // namespace naiad
