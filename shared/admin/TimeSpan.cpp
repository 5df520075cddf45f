#include "shared/admin/TimeSpan.h"

#include <cmath>
#include <cstdint>
#include <ctime>

#include "shared/options/Duration.h"

namespace naiad {

namespace {

struct SpanUnit {
  char letter;
  std::int64_t seconds;
};
constexpr SpanUnit kSpanUnits[] = {{'d', 86'400}, {'h', 3600}, {'m', 60}, {'s', 1}};

}  // namespace

std::optional<std::chrono::seconds> readTimeSpan(std::string_view text) {
  const auto seconds = readDuration(text);
  if (!seconds || *seconds < 1 || *seconds > static_cast<double>(kMaxTimeSpan.count())) return std::nullopt;
  return std::chrono::seconds(std::llround(*seconds));
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
