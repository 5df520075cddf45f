#include "shared/program/LogFormat.h"

#include <ctime>
#include <string_view>

#include "shared/json/Json.h"
#include "shared/program/LogText.h"

namespace naiad {

namespace {

constexpr std::size_t kMaxField = 128;  ///< bytes of a value in JSON: addresses, names, refusals

std::string localTime(std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  localtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S ", &parts);
  return text;
}

std::string universalTime(std::chrono::system_clock::time_point time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  const auto millis = std::chrono::duration_cast<std::chrono::milliseconds>(time - seconds).count();
  const std::time_t count = std::chrono::system_clock::to_time_t(seconds);
  std::tm parts{};
  gmtime_r(&count, &parts);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
  char text[48];
  std::snprintf(text, sizeof text, "%s.%03dZ", date, static_cast<int>(millis));
  return text;
}

const char* nameOf(LogEvent::Level level) {
  switch (level) {
    case LogEvent::Level::kError:
      return "error";
    case LogEvent::Level::kWarning:
      return "warning";
    case LogEvent::Level::kInfo:
      break;
  }
  return "info";
}

std::string asJson(const LogEvent& event, std::string_view text, const std::string& time) {
  Json line{{"time", time}, {"level", nameOf(event.level)}, {"event", event.name}, {"text", oneLine(text)}};
  for (const auto& [name, value] : event.fields) line.set(name, oneLine(value).substr(0, kMaxField));
  return line.toString() + '\n';  // with U+FFFD for half a character that a cut has left
}

}  // namespace

std::string formatEvent(const LogEvent& event, LogFormat format, std::chrono::system_clock::time_point time,
                        std::size_t max_bytes) {
  if (format == LogFormat::kJson) {
    const std::string stamp = universalTime(time);
    std::string_view text = event.text;
    for (std::string line = asJson(event, text, stamp);; line = asJson(event, text, stamp)) {
      if (line.size() <= max_bytes || text.empty()) return line;
      text = text.substr(0, text.size() / 2);
    }
  }
  std::string line = (format == LogFormat::kText ? localTime(time) : std::string()) + oneLine(event.text);
  if (line.size() >= max_bytes) line.resize(max_bytes - 1);
  return line + '\n';
}

}  // namespace naiad
