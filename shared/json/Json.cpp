#include "shared/json/Json.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace naiad {

namespace {

/// Builds a value from the parser's events. An event that returns false ends the parse.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  JsonBuilder(std::size_t max_depth, Json::Duplicates duplicates)
      : m_max_depth(max_depth), m_duplicates(duplicates) {}

  Json popResult() { return std::move(m_levels.front().elements.front()); }

  bool null() override { return add(Json()); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*count*/) override { return open(true); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*count*/) override { return open(false); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    Level& level = m_levels.back();
    const auto [found, is_new] = level.places.try_emplace(name, level.members.size());
    level.current = found->second;
    if (is_new) level.members.emplace_back(std::move(name), Json());
    return is_new || m_duplicates == Json::Duplicates::kKeepLast;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  /// An array or object whose end has not been read.
  struct Level {
    bool is_object;
    Json::Array elements = {};
    Json::Object members = {};
    std::map<std::string, std::size_t> places = {};  ///< indices into `members`, by name
    std::size_t current = 0;                         ///< index of the member that gets the next value
  };

  bool add(Json value) {
    Level& level = m_levels.back();
    (level.is_object ? level.members[level.current].second : level.elements.emplace_back()) =
        std::move(value);
    return true;
  }

  bool open(bool is_object) {
    m_levels.push_back({is_object});
    return m_levels.size() <= m_max_depth + 1;
  }

  bool close() {
    Level level = std::move(m_levels.back());
    m_levels.pop_back();
    return add(level.is_object ? Json(std::move(level.members)) : Json(std::move(level.elements)));
  }

  const std::size_t m_max_depth;
  const Json::Duplicates m_duplicates;
  std::vector<Level> m_levels{{false}};  ///< open levels; the first one receives the result
};

}  // namespace

std::optional<Json> Json::parse(std::string_view text, std::size_t max_depth, Duplicates duplicates) {
  if (text.find('\0') != std::string_view::npos) return std::nullopt;  // the library would stop there
  JsonBuilder builder(max_depth, duplicates);
  return nlohmann::json::sax_parse(text, &builder) ? std::optional(builder.popResult()) : std::nullopt;
}

std::string Json::toString(Style style) const {
  const bool ascii = style == Style::kAscii;
  const char* const p_comma = ascii ? ", " : ",";
  std::string text;
  if (const Array* const p_elements = array()) {
    for (const Json& element : *p_elements) text += (text.empty() ? "" : p_comma) + element.toString(style);
    return "[" + text + "]";
  }
  if (const Object* const p_members = object()) {
    for (const auto& [name, value] : *p_members)
      text += (text.empty() ? "" : p_comma) + Json(name).toString(style) + (ascii ? ": " : ":") +
              value.toString(style);
    return "{" + text + "}";
  }
  const auto write = [&]<class T>(const T& scalar) {
    if constexpr (!std::is_same_v<T, Array> && !std::is_same_v<T, Object>)
      text = nlohmann::json(scalar).dump(-1, ' ', ascii, nlohmann::json::error_handler_t::replace);
  };
  std::visit(write, m_value);
  return text;
}

std::optional<std::int64_t> Json::integer() const {
  if (const auto* p_value = std::get_if<std::int64_t>(&m_value)) return *p_value;
  const auto* p_value = std::get_if<std::uint64_t>(&m_value);
  return p_value != nullptr && *p_value <= INT64_MAX ? std::optional(*p_value) : std::nullopt;
}

std::optional<double> Json::number() const {
  if (const auto* p_value = std::get_if<double>(&m_value)) return *p_value;
  if (const auto* p_value = std::get_if<std::uint64_t>(&m_value)) return *p_value;
  return integer();
}

const Json* Json::find(std::string_view name) const {
  if (object() == nullptr) return nullptr;
  for (const auto& [member, value] : *object()) {
    if (member == name) return &value;
  }
  return nullptr;
}

const Json& Json::operator[](std::string_view name) const {
  static const Json null;
  const Json* const p_value = find(name);
  return p_value != nullptr ? *p_value : null;
}

void Json::set(std::string_view name, Json value) {
  if (object() == nullptr) m_value = Object();
  auto& members = std::get<Object>(m_value);
  const auto found = std::find_if(members.begin(), members.end(),
                                  [name](const Member& member) { return member.first == name; });
  (found != members.end() ? found->second : members.emplace_back(name, Json()).second) = std::move(value);
}

}  // namespace naiad
