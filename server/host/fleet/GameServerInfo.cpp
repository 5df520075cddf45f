#include "host/fleet/GameServerInfo.h"

#include <algorithm>

#include "shared/json/Json.h"

namespace naiad {

namespace {

constexpr std::size_t kMaxDepth = 32;  ///< more than the JSON of any sidecar needs
constexpr std::size_t kMaxText = 253;  ///< maximum length of Kubernetes names and host names
constexpr int kMaxHealthSeconds = 3600;

/// Returns a JSON string; empty if it is another type, too long, or has characters other than ! to ~.
std::string textOf(const Json& value) {
  std::string text = value.textOrEmpty();
  const bool good = text.size() <= kMaxText &&
                    std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
  return good ? text : "";
}

/// Returns a JSON number; 0 if it is not an integer from 1 to `most`.
int numberOf(const Json& value, int most) {
  const std::int64_t number = value.integer().value_or(0);
  return number >= 1 && number <= most ? static_cast<int>(number) : 0;
}

}  // namespace

std::optional<GameServerInfo> GameServerInfo::parse(std::string_view text, bool is_line) {
  if (text.size() > kMaxBytes) return std::nullopt;
  const Json all = Json::parse(text, kMaxDepth, Json::Duplicates::kKeepLast).value_or(Json());
  const Json& server = is_line ? all["result"] : all;
  if (server.object() == nullptr) return std::nullopt;
  const Json& status = server["status"];
  GameServerInfo facts;
  facts.name = textOf(server["object_meta"]["name"]);
  facts.state = textOf(status["state"]);
  facts.address = textOf(status["address"]);
  const auto* const p_ports = status["ports"].array();
  if (p_ports != nullptr && !p_ports->empty())
    facts.port = static_cast<std::uint16_t>(numberOf(p_ports->front()["port"], 65'535));
  facts.health_seconds = numberOf(server["spec"]["health"]["period_seconds"], kMaxHealthSeconds);
  return facts;
}

}  // namespace naiad
