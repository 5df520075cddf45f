#include "shared/fleet/BusFields.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "shared/net/base/SafeText.h"

namespace naiad {

/// Of one object without others in it: nothing is kept of anything deeper, and it ends there.
class BusFieldsReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit BusFieldsReader(std::map<std::string, BusFields::Value>& values) : m_values(values) {}

  bool null() override { return m_depth == 1; }
  bool boolean(bool value) override { return keep(value); }
  bool number_integer(number_integer_t value) override { return keep(std::int64_t{value}); }
  bool number_unsigned(number_unsigned_t value) override {
    return value <= static_cast<number_unsigned_t>(INT64_MAX) && keep(static_cast<std::int64_t>(value));
  }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return m_depth == 1; }
  bool string(string_t& value) override { return keep(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*count*/) override { return ++m_depth == 1; }
  bool end_object() override { return true; }
  bool start_array(std::size_t /*count*/) override { return false; }
  bool end_array() override { return false; }
  /// The same one twice is nothing that a server writes.
  bool key(string_t& name) override {
    m_name = name;
    return m_names.insert(name).second;
  }
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*what*/) override {
    return false;
  }

 private:
  bool keep(BusFields::Value value) {
    if (m_depth != 1) return false;
    m_values.insert_or_assign(m_name, std::move(value));
    return true;
  }

  std::map<std::string, BusFields::Value>& m_values;
  std::set<std::string> m_names;
  std::string m_name;
  int m_depth = 0;
};

BusFields::BusFields(std::string_view payload) {
  BusFieldsReader reader(m_values);
  m_ok = payload.size() <= kMaxBusPayload && nlohmann::json::sax_parse(payload, &reader);
}

template <class T>
T BusFields::take(const std::string& name) {
  const auto found = m_values.find(name);
  const T* p_value = found != m_values.end() ? std::get_if<T>(&found->second) : nullptr;
  if (p_value == nullptr) m_ok = false;
  return p_value != nullptr ? *p_value : T();
}

std::int64_t BusFields::number(const std::string& name, std::int64_t least, std::int64_t most) {
  const auto value = take<std::int64_t>(name);
  if (value >= least && value <= most) return value;
  m_ok = false;
  return least;
}

bool BusFields::flag(const std::string& name) {
  return take<bool>(name);
}

std::string BusFields::line(const std::string& name, std::size_t most) {
  auto value = take<std::string>(name);
  if (safeText(value, most) == value) return value;
  m_ok = false;
  return "";
}

std::string BusFields::word(const std::string& name, std::size_t most) {
  auto value = take<std::string>(name);
  const bool good = value.size() <= most &&
                    std::all_of(value.begin(), value.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (good) return value;
  m_ok = false;
  return "";
}

}  // namespace naiad
