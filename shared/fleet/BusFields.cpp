#include "shared/fleet/BusFields.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"

namespace naiad {

BusFields::BusFields(std::string_view payload) {
  if (payload.size() <= kMaxBusPayload) m_object = Json::parse(payload, 1).value_or(Json());
  m_ok = m_object.object() != nullptr &&
         std::ranges::none_of(*m_object.object(), [](const Json::Member& member) {
           return member.second.isInteger() && !member.second.integer();  // beyond 63 bits
         });
}

bool BusFields::has(std::string_view name) const {
  const Json& value = m_object[name];
  return value.text() != nullptr || value.integer() || value.boolean() != nullptr;
}

std::int64_t BusFields::number(std::string_view name, std::int64_t least, std::int64_t most) {
  const auto value = m_object[name].integer();
  if (value && *value >= least && *value <= most) return *value;
  m_ok = false;
  return least;
}

bool BusFields::flag(std::string_view name) {
  const bool* const p_value = m_object[name].boolean();
  if (p_value == nullptr) m_ok = false;
  return p_value != nullptr && *p_value;
}

std::string BusFields::line(std::string_view name, std::size_t most) {
  const std::string* const p_value = m_object[name].text();
  if (p_value != nullptr && safeText(*p_value, most) == *p_value) return *p_value;
  m_ok = false;
  return "";
}

std::string BusFields::word(std::string_view name, std::size_t most) {
  const std::string* const p_value = m_object[name].text();
  const bool good = p_value != nullptr && p_value->size() <= most &&
                    std::all_of(p_value->begin(), p_value->end(), [](char c) { return c > ' ' && c <= '~'; });
  if (good) return *p_value;
  m_ok = false;
  return "";
}

}  // namespace naiad
