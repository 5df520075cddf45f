#include "shared/options/Duration.h"

#include <charconv>
#include <cmath>
#include <ctime>
#include <span>
#include <utility>

namespace naiad {

namespace {

constexpr std::pair<const char*, std::int64_t> kUnits[] = {
    {"d", 86'400 * kSecond},     {"h", 3600 * kSecond}, {"m", 60 * kSecond}, {"s", kSecond},
    {"w", kSecond * 86'400 * 7}, {"ms", kMillisecond},  {"us", kMicrosecond}};

}  // namespace

std::optional<double> readDuration(std::string_view text, std::int64_t unit) {
  double count = 0;
  const char* const p_end = text.data() + text.size();
  const auto [p_read, error] = std::from_chars(text.data(), p_end, count);
  if (error != std::errc() || !std::isfinite(count)) return std::nullopt;
  if (p_read == p_end) return count;
  for (const auto& [name, micros] : kUnits) {
    if (std::string_view(p_read, p_end) == name)
      return count * static_cast<double>(micros) / static_cast<double>(unit);
  }
  return std::nullopt;
}

std::optional<std::chrono::seconds> readTimeSpan(std::string_view text) {
  const auto seconds = readDuration(text);
  if (!seconds || *seconds < 1 || *seconds > static_cast<double>(kMaxTimeSpan.count())) return std::nullopt;
  return std::chrono::seconds(std::llround(*seconds));
}

std::string timeSpanText(std::chrono::seconds span) {
  const std::int64_t count = span.count() > 0 ? span.count() : 0;
  for (const auto& [name, micros] : std::span(kUnits).first(4)) {
    const std::int64_t seconds = micros / kSecond;
    if (count != 0 && count % seconds == 0) return std::to_string(count / seconds) + name;
  }
  return "0s";
}

std::string timeText(std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  char text[32] = "";
  if (gmtime_r(&seconds, &parts) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
  return text;
}

}  // namespace naiad
