#include "client/trust/TokenStore.h"

#include <limits>
#include <utility>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::string_view kFirstLine = "naiad session 1";
constexpr std::size_t kMaxToken = 64;
constexpr std::int64_t kMaxGrace = 3'600'000;  // ms

/// Removes the next line from `text` and returns its value. Nullopt if there is no line end, or the line does
/// not begin with `key` and a blank.
std::optional<std::string_view> takeLine(std::string_view& text, std::string_view key) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  if (!line.starts_with(key) || line.size() <= key.size() || line[key.size()] != ' ') return std::nullopt;
  return line.substr(key.size() + 1);
}

std::optional<std::int64_t> takeNumber(std::string_view& text, std::string_view key) {
  const auto value = takeLine(text, key);
  return value ? readNumber<std::int64_t>(*value, 0, std::numeric_limits<std::int64_t>::max()) : std::nullopt;
}

}  // namespace

std::optional<std::string> writeSavedSession(const SavedSession& session) {
  const auto millis = [](auto time) {
    return std::to_string(std::chrono::floor<std::chrono::milliseconds>(time).count());
  };
  std::string text = std::string(kFirstLine) + "\nserver " + session.server + "\nkey " + session.key.text() +
                     "\nname " + session.name + "\ntoken " + hexText(session.token) + "\ngrace " +
                     millis(session.grace) + "\nalive " + millis(session.alive.time_since_epoch()) + "\n";
  if (text.size() > kSavedSessionSize) return std::nullopt;
  text.resize(kSavedSessionSize, '\n');
  if (!readSavedSession(text)) return std::nullopt;
  return text;
}

std::optional<SavedSession> readSavedSession(std::string_view text) {
  if (text.size() != kSavedSessionSize || !text.starts_with(kFirstLine)) return std::nullopt;
  text.remove_prefix(kFirstLine.size());
  if (!text.starts_with('\n')) return std::nullopt;
  text.remove_prefix(1);
  const auto server = takeLine(text, "server");
  const auto key = takeLine(text, "key");
  const auto name = takeLine(text, "name");
  const auto token = takeLine(text, "token");
  const auto grace = takeNumber(text, "grace");
  const auto alive = takeNumber(text, "alive");
  if (!server || !key || !name || !token || !grace || !alive || *grace > kMaxGrace) return std::nullopt;
  if (text.find_first_not_of('\n') != std::string_view::npos) return std::nullopt;
  const auto fingerprint = Fingerprint::parse(*key);
  auto bytes = bytesOfHex(*token);
  constexpr std::int64_t kLatest = std::int64_t{1} << 42;  // ms; later times do not fit the clock's type
  if (!fingerprint || !bytes || bytes->empty() || bytes->size() > kMaxToken || *alive > kLatest)
    return std::nullopt;
  return SavedSession{std::string(*server),
                      *fingerprint,
                      std::string(*name),
                      std::move(*bytes),
                      std::chrono::milliseconds(*grace),
                      SavedSession::Time(std::chrono::milliseconds(*alive))};
}

}  // namespace naiad
