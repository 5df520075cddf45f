#include "host/fleet/GameServerFacts.h"

#include <nlohmann/json.hpp>

namespace naiad {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxText = 253;  ///< of a name in a cluster, and of a host's
constexpr int kMaxHealthSeconds = 3600;

/// Null for what is no object or has no such member.
const Json& member(const Json& object, const char* p_name) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(p_name);
  return found != object.end() ? *found : none;
}

/// Empty for other kinds, and for texts that are too long or are not printable.
std::string textOf(const Json& object, const char* p_name) {
  const Json& value = member(object, p_name);
  if (!value.is_string()) return "";
  const auto& text = value.get_ref<const std::string&>();
  for (const char c : text) {
    if (c <= ' ' || c > '~') return "";
  }
  return text.size() <= kMaxText ? text : "";
}

/// 0 for what is no number from 1 to `most`.
int numberOf(const Json& object, const char* p_name, int most) {
  const Json& value = member(object, p_name);
  if (!value.is_number_integer()) return 0;
  const auto number = value.is_number_unsigned() && value.get<std::uint64_t>() > INT32_MAX
                          ? std::int64_t{0}
                          : value.get<std::int64_t>();
  return number >= 1 && number <= most ? static_cast<int>(number) : 0;
}

/// Not deeper than any that a sidecar sends: parsing takes stack for each level.
bool isFlat(std::string_view text) {
  constexpr int kMaxDepth = 32;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxDepth) return false;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return true;
}

}  // namespace

std::optional<GameServerFacts> GameServerFacts::parse(std::string_view text, bool is_line) {
  if (text.size() > kMaxBytes || !isFlat(text)) return std::nullopt;
  const Json all = Json::parse(text, nullptr, false);
  const Json& server = is_line ? member(all, "result") : all;
  if (!server.is_object()) return std::nullopt;
  const Json& status = member(server, "status");
  GameServerFacts facts;
  facts.name = textOf(member(server, "object_meta"), "name");
  facts.state = textOf(status, "state");
  facts.address = textOf(status, "address");
  const Json& ports = member(status, "ports");
  if (ports.is_array() && !ports.empty())
    facts.port = static_cast<std::uint16_t>(numberOf(ports.front(), "port", 65'535));
  facts.health_seconds =
      numberOf(member(member(server, "spec"), "health"), "period_seconds", kMaxHealthSeconds);
  return facts;
}

}  // namespace naiad
