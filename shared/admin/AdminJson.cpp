#include "shared/admin/AdminJson.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace naiad {

namespace {

using Json = nlohmann::ordered_json;  // the order of columns is the answer's

constexpr int kMaxDepth = 2;  ///< of what a server reads: an object in an object
/// Of an answer's lines: leaves room for what stands around the rows.
constexpr std::size_t kMaxRowBytes = kMaxControlLine - 512;
constexpr std::size_t kMaxTextBytes = 2048;  ///< of one text in a line
constexpr std::size_t kMaxCellBytes = 384;   ///< of one as JSON in a row: several fit a line

/// Text of a log or a player need be no UTF-8; what is written always is.
std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string lineOf(const Json& json) {
  return dumped(json) + "\n";
}

/// Nothing if it is no JSON, has a key twice in one object, or is deeper than `most`.
std::optional<Json> parseStrictly(std::string_view line, int most) {
  if (line.find('\0') != std::string_view::npos) return std::nullopt;  // would end the text for the parser
  bool strict = true;
  std::vector<std::set<std::string>> keys;
  const auto judge = [&](int depth, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if ((event == Event::object_start || event == Event::array_start) && depth >= most) strict = false;
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::key && !keys.back().insert(parsed.get<std::string>()).second) strict = false;
    if (event == Event::object_end) keys.pop_back();
    return true;
  };
  Json json = Json::parse(line.begin(), line.end(), judge, false);
  if (json.is_discarded() || !strict) return std::nullopt;
  return json;
}

std::string argumentText(const std::string& name, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return dumped(value);
  throw AdminUsageError("The argument \"" + name + "\" is no text.");
}

// Whole characters only: half of one would become a replacement character.
std::string cut(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
  return std::string(text.substr(0, most)) + "…";
}

/// The same, until it has so many bytes as JSON: an escape can be six times as long as what it stands for.
std::string cutToFit(std::string_view text, std::size_t json_bytes = kMaxRowBytes) {
  std::string kept = cut(text, kMaxTextBytes);
  for (std::size_t most = kMaxTextBytes; dumped(kept).size() > json_bytes;) kept = cut(text, most /= 2);
  return kept;
}

Json jsonOf(const AdminValue& value) {
  if (const auto* p_text = std::get_if<std::string>(&value)) return cutToFit(*p_text, kMaxCellBytes);
  return std::visit([](const auto& one) { return Json(one); }, value);
}

Json jsonOf(const AdminRow& row) {
  Json object = Json::object();
  for (const auto& [name, value] : row) object[name] = jsonOf(value);
  return object;
}

AdminValue valueOf(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  return json.is_string() ? json.get<std::string>() : dumped(json);
}

AdminRow rowOf(const Json& json) {
  AdminRow row;
  if (!json.is_object()) return row;
  for (const auto& [name, value] : json.items()) row.emplace_back(name, valueOf(value));
  return row;
}

std::string textIn(const Json& json, const char* p_key) {
  const auto found = json.find(p_key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

AdminRequest readRequestLine(std::string_view line) {
  const auto json = parseStrictly(line, kMaxDepth);
  if (!json || !json->is_object())
    throw AdminUsageError("One JSON object is wanted, like {\"command\":\"who\"}.");
  std::map<std::string, std::string> arguments;
  for (const auto& [key, value] : json->items()) {
    if (key == "command" && value.is_string()) continue;
    if (key != "arguments" || !value.is_object())
      throw AdminUsageError("\"command\" with a text and \"arguments\" with an object are wanted.");
    for (const auto& [name, argument] : value.items()) arguments[name] = argumentText(name, argument);
  }
  if (!json->contains("command")) throw AdminUsageError("\"command\" is missing.");
  return readAdminRequest((*json)["command"].get<std::string>(), std::move(arguments));
}

std::string requestLine(const AdminRequest& request) {
  Json json{{"command", request.command->name}};
  if (!request.arguments.empty()) json["arguments"] = request.arguments;
  return lineOf(json);
}

std::string answerLines(const AdminAnswer& answer) {
  std::string lines;
  if (!answer.ok) {
    Json json{{"ok", false}, {"error", cutToFit(answer.text)}};
    Json names = Json::array();
    for (const std::string& name : answer.candidates) {
      names.push_back(name);
      if (dumped(names).size() > kMaxRowBytes / 4) break;
    }
    if (!names.empty()) json["candidates"] = names;
    return lineOf(json);
  }
  Json rows = Json::array();
  std::size_t bytes = 0;
  for (const AdminRow& row : answer.rows) {
    Json object = jsonOf(row);
    const std::size_t size = dumped(object).size() + 1;
    if (bytes + size > kMaxRowBytes && !rows.empty()) {
      lines += lineOf(Json{{"rows", std::move(rows)}, {"more", true}});
      rows = Json::array();
      bytes = 0;
    }
    rows.push_back(std::move(object));
    bytes += size;
  }
  if (!rows.empty() && (!answer.text.empty() || !answer.facts.empty())) {
    lines += lineOf(Json{{"rows", std::move(rows)}, {"more", true}});
    rows = Json::array();
  }
  Json last{{"ok", true}};
  if (!answer.text.empty()) last["text"] = cutToFit(answer.text);
  if (!answer.facts.empty()) last["facts"] = jsonOf(answer.facts);
  if (answer.is_list) last["rows"] = std::move(rows);
  return lines + lineOf(last);
}

std::string eventLine(std::string_view kind, std::string_view text) {
  return lineOf(Json{{"event", std::string(kind)}, {"text", cutToFit(text)}});
}

std::string droppedLine(std::uint64_t count) {
  return lineOf(Json{{"dropped", count}});
}

AnswerReader::Got AnswerReader::readLine(std::string_view line) {
  const Json json = Json::parse(line.begin(), line.end(), nullptr, false);
  if (!json.is_object()) return Got::kNonsense;
  if (const auto rows = json.find("rows"); rows != json.end() && rows->is_array()) {
    m_answer.is_list = true;
    for (const Json& row : *rows) m_answer.rows.push_back(rowOf(row));
  }
  if (json.contains("event")) {
    m_event = textIn(json, "text");
    return Got::kEvent;
  }
  if (const auto dropped = json.find("dropped"); dropped != json.end() && dropped->is_number_unsigned()) {
    m_dropped = dropped->get<std::uint64_t>();
    return Got::kDropped;
  }
  if (json.contains("more")) return Got::kMore;
  const auto ok = json.find("ok");
  if (ok == json.end() || !ok->is_boolean()) return Got::kNonsense;
  m_answer.ok = ok->get<bool>();
  m_answer.text = textIn(json, m_answer.ok ? "text" : "error");
  if (const auto facts = json.find("facts"); facts != json.end()) m_answer.facts = rowOf(*facts);
  if (const auto names = json.find("candidates"); names != json.end() && names->is_array()) {
    for (const Json& name : *names) {
      if (name.is_string()) m_answer.candidates.push_back(name.get<std::string>());
    }
  }
  return Got::kAnswer;
}

std::string answerJson(const AdminAnswer& answer) {
  if (!answer.ok) {
    Json json{{"error", answer.text}};
    if (!answer.candidates.empty()) json["candidates"] = answer.candidates;
    return dumped(json);
  }
  if (answer.is_list) {
    Json rows = Json::array();
    for (const AdminRow& row : answer.rows) rows.push_back(jsonOf(row));
    return dumped(rows);
  }
  return dumped(answer.facts.empty() ? Json{{"text", answer.text}} : jsonOf(answer.facts));
}

}  // namespace naiad
