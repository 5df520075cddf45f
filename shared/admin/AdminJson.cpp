#include "shared/admin/AdminJson.h"

#include <map>
#include <utility>
#include <variant>

#include "shared/json/Json.h"

namespace naiad {

namespace {

constexpr std::size_t kMaxDepth = 2;         ///< maximum nesting of a request: one object in another
constexpr std::size_t kMaxAnswerDepth = 32;  ///< maximum nesting of an answer that dfctl reads
/// Maximum bytes of rows in a line of an answer. The rest of the line holds the JSON around the rows.
constexpr std::size_t kMaxRowBytes = kMaxControlLine - 512;
constexpr std::size_t kMaxTextBytes = 2048;  ///< maximum bytes of one text in a line
constexpr std::size_t kMaxCellBytes = 384;   ///< maximum bytes of one text in a row, as JSON

std::string lineOf(const Json& json) {
  return json.toString() + "\n";
}

std::string argumentText(const std::string& name, const Json& value) {
  if (const auto* p_text = value.text()) return *p_text;
  if (value.isInteger()) return value.toString();
  throw AdminUsageError("The argument \"" + name + "\" must be a text or an integer.");
}

// If the text is longer than `most` bytes, shortens it to that and appends "…". Never splits a character.
std::string cut(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
  return std::string(text.substr(0, most)) + "…";
}

/// Shortens the text to kMaxTextBytes like cut(), then further until it has at most `json_bytes` as JSON. An
/// escape takes up to six bytes.
std::string cutToFit(std::string_view text, std::size_t json_bytes = kMaxRowBytes) {
  std::string kept = cut(text, kMaxTextBytes);
  for (std::size_t most = kMaxTextBytes; Json(kept).toString().size() > json_bytes;)
    kept = cut(text, most /= 2);
  return kept;
}

Json jsonOf(const AdminValue& value) {
  if (const auto* p_text = std::get_if<std::string>(&value)) return cutToFit(*p_text, kMaxCellBytes);
  return std::visit([](const auto& one) { return Json(one); }, value);
}

Json jsonOf(const AdminRow& row) {
  Json object = Json::Object();
  for (const auto& [name, value] : row) object.set(name, jsonOf(value));
  return object;
}

AdminValue valueOf(const Json& json) {
  if (const auto* p_flag = json.boolean()) return *p_flag;
  if (const auto integer = json.integer()) return *integer;
  if (const auto number = json.number()) return *number;
  return json.text() != nullptr ? *json.text() : json.toString();
}

AdminRow rowOf(const Json& json) {
  AdminRow row;
  if (json.object() == nullptr) return row;
  for (const auto& [name, value] : *json.object()) row.emplace_back(name, valueOf(value));
  return row;
}

}  // namespace

AdminRequest readRequestLine(std::string_view line) {
  const auto json = Json::parse(line, kMaxDepth);
  if (!json || json->object() == nullptr)
    throw AdminUsageError("Expected one JSON object, like {\"command\":\"who\"}.");
  std::map<std::string, std::string> arguments;
  for (const auto& [key, value] : *json->object()) {
    if (key == "command" && value.text() != nullptr) continue;
    if (key != "arguments" || value.object() == nullptr)
      throw AdminUsageError("Expected only \"command\" with a text and \"arguments\" with an object.");
    for (const auto& [name, argument] : *value.object()) arguments[name] = argumentText(name, argument);
  }
  const auto* p_command = (*json)["command"].text();
  if (p_command == nullptr) throw AdminUsageError("\"command\" is missing.");
  return readAdminRequest(*p_command, std::move(arguments));
}

std::string requestLine(const AdminRequest& request) {
  Json json{{"command", request.command->name}};
  if (!request.arguments.empty())
    json.set("arguments", Json::Object(request.arguments.begin(), request.arguments.end()));
  return lineOf(json);
}

std::string answerLines(const AdminAnswer& answer) {
  std::string lines;
  if (!answer.ok) {
    Json json{{"ok", false}, {"error", cutToFit(answer.text)}};
    Json::Array names;
    for (const std::string& name : answer.candidates) {
      names.emplace_back(name);
      if (Json(names).toString().size() > kMaxRowBytes / 4) break;
    }
    if (!names.empty()) json.set("candidates", names);
    return lineOf(json);
  }
  Json::Array rows;
  std::size_t bytes = 0;
  const auto flush = [&] {
    lines += lineOf({{"rows", std::exchange(rows, {})}, {"more", true}});
    bytes = 0;
  };
  for (const AdminRow& row : answer.rows) {
    Json object = jsonOf(row);
    const std::size_t size = object.toString().size() + 1;
    if (bytes + size > kMaxRowBytes && !rows.empty()) flush();
    rows.push_back(std::move(object));
    bytes += size;
  }
  if (!rows.empty() && (!answer.text.empty() || !answer.facts.empty())) flush();
  Json last{{"ok", true}};
  if (!answer.text.empty()) last.set("text", cutToFit(answer.text));
  if (!answer.facts.empty()) last.set("facts", jsonOf(answer.facts));
  if (answer.is_list) last.set("rows", std::move(rows));
  return lines + lineOf(last);
}

std::string eventLine(std::string_view kind, std::string_view text) {
  return lineOf({{"event", std::string(kind)}, {"text", cutToFit(text)}});
}

std::string droppedLine(std::uint64_t count) {
  return lineOf({{"dropped", count}});
}

AnswerReader::LineKind AnswerReader::readLine(std::string_view line) {
  const Json json = Json::parse(line, kMaxAnswerDepth, Json::Duplicates::kKeepLast).value_or(Json());
  if (const auto* p_rows = json["rows"].array()) {
    m_answer.is_list = true;
    for (const Json& row : *p_rows) m_answer.rows.push_back(rowOf(row));
  }
  if (json.find("event") != nullptr) {
    m_event = json["text"].textOrEmpty();
    return LineKind::kEvent;
  }
  if (const auto dropped = json["dropped"].integer(); dropped && *dropped >= 0) {
    m_dropped = static_cast<std::uint64_t>(*dropped);
    return LineKind::kDropped;
  }
  if (json.find("more") != nullptr) return LineKind::kMore;
  const auto* p_ok = json["ok"].boolean();
  if (p_ok == nullptr) return LineKind::kMalformed;
  m_answer.ok = *p_ok;
  m_answer.text = json[m_answer.ok ? "text" : "error"].textOrEmpty();
  if (const auto* p_facts = json.find("facts")) m_answer.facts = rowOf(*p_facts);
  if (const auto* p_names = json["candidates"].array()) {
    for (const Json& name : *p_names) {
      if (const auto* p_text = name.text()) m_answer.candidates.push_back(*p_text);
    }
  }
  return LineKind::kAnswer;
}

std::string answerJson(const AdminAnswer& answer) {
  if (!answer.ok) {
    Json json{{"error", answer.text}};
    if (!answer.candidates.empty())
      json.set("candidates", Json::Array(answer.candidates.begin(), answer.candidates.end()));
    return json.toString();
  }
  if (answer.is_list) {
    Json::Array rows;
    for (const AdminRow& row : answer.rows) rows.push_back(jsonOf(row));
    return Json(std::move(rows)).toString();
  }
  return (answer.facts.empty() ? Json{{"text", answer.text}} : jsonOf(answer.facts)).toString();
}

}  // namespace naiad
