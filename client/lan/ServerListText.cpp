#include "client/lan/ServerListText.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

using Row = std::array<std::string, 5>;

Row rowOf(const FoundServer& server) {
  const std::string link = server.link();
  return {server.name, server.game, placesOf(server), noteOf(server),
          link.empty() ? server.where.text() : link};
}

Json jsonOf(const FoundServer& server) {
  Json json = jsonOf(static_cast<const ServerFacts&>(server));
  json.set("address", server.where.text());
  json.set("key", server.key.text());
  json.set("link", server.link().empty() ? Json() : server.link());
  return json;
}

}  // namespace

std::string placesOf(const FoundServer& server) {
  return std::to_string(server.players) + "/" + std::to_string(server.max_players);
}

std::string noteOf(const FoundServer& server) {
  if (!server.isPlayable()) return "version " + std::to_string(server.protocol);
  if (server.players >= server.max_players) return "full";
  return server.asks_password ? "password" : "";
}

std::string serversAsText(const std::vector<FoundServer>& servers) {
  if (servers.empty()) {
    std::string text;
    for (const char* p_line : kNoServersFound) text += std::string(p_line) + "\n";
    return text;
  }
  std::vector<Row> rows{{"NAME", "GAME", "PLAYERS", "NOTE", "SERVER"}};
  for (const FoundServer& server : servers) rows.push_back(rowOf(server));
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

std::string serversAsJson(const std::vector<FoundServer>& servers) {
  std::string text = "[";
  for (const FoundServer& server : servers)
    text += (text.size() > 1 ? ",\n " : "") + jsonOf(server).toString(Json::Style::kAscii);
  return text + "]\n";
}

}  // namespace naiad
