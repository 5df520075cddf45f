#include "shared/admin/TimeSpan.h"

#include <cstdint>
#include <ctime>

#include "shared/net/base/SafeText.h"

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
  if (unit == 0) return std::nullopt;
  text.remove_suffix(1);
  const auto count = readNumber<std::int64_t>(text, 1, kMaxTimeSpan.count() / unit);
  return count ? std::optional(std::chrono::seconds(*count * unit)) : std::nullopt;
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
