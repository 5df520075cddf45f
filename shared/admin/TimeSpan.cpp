#include "shared/admin/TimeSpan.h"

#include <charconv>
#include <cstdint>
#include <ctime>

namespace naiad {

namespace {

struct SpanUnit {
  char letter;
  std::int64_t seconds;
};
constexpr SpanUnit kSpanUnits[] = {{'d', 86'400}, {'h', 3600}, {'m', 60}, {'s', 1}};
constexpr std::int64_t kWeek = std::int64_t{7} * 86'400;

std::int64_t secondsOf(char letter) {
  for (const SpanUnit& unit : kSpanUnits) {
    if (unit.letter == letter) return unit.seconds;
  }
  return letter == 'w' ? kWeek : 0;
}

}  // namespace

std::optional<std::chrono::seconds> readTimeSpan(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  const std::int64_t unit = secondsOf(text.back());
  const char* const p_end = text.data() + text.size() - 1;
  std::int64_t count = 0;
  const auto [p_read, error] = std::from_chars(text.data(), p_end, count);
  if (unit == 0 || error != std::errc() || p_read != p_end) return std::nullopt;
  if (count < 1 || count > kMaxTimeSpan.count() / unit) return std::nullopt;
  return std::chrono::seconds(count * unit);
}

std::string timeSpanText(std::chrono::seconds span) {
  const std::int64_t count = span.count() > 0 ? span.count() : 0;
  for (const SpanUnit& unit : kSpanUnits) {
    if (count != 0 && count % unit.seconds == 0) return std::to_string(count / unit.seconds) + unit.letter;
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
