#include "shared/options/Duration.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace naiad {

namespace {

constexpr std::pair<std::string_view, std::int64_t> kUnits[] = {
    {"us", kMicrosecond},  {"ms", kMillisecond},    {"s", kSecond},           {"m", 60 * kSecond},
    {"h", 3600 * kSecond}, {"d", 86'400 * kSecond}, {"w", 7 * 86'400 * kSecond}};

}  // namespace

std::optional<double> readDuration(std::string_view text, std::int64_t unit) {
  double count = 0;
  const char* const p_end = text.data() + text.size();
  const auto [p_read, error] = std::from_chars(text.data(), p_end, count);
  const std::string_view rest(p_read, static_cast<std::size_t>(p_end - p_read));
  if (error != std::errc() || !std::isfinite(count)) return std::nullopt;
  if (rest.empty()) return count;
  for (const auto& [name, micros] : kUnits) {
    if (rest == name) return count * static_cast<double>(micros) / static_cast<double>(unit);
  }
  return std::nullopt;
}

bool isDurationWithUnit(std::string_view text) {
  return readDuration(text) && text.find_first_not_of("-.0123456789e") != std::string_view::npos;
}

}  // namespace naiad
