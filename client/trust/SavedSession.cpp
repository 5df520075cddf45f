#include "client/trust/SavedSession.h"

#include <charconv>
#include <utility>

namespace naiad {
namespace {

constexpr std::string_view kFirstLine = "naiad session 1";
constexpr std::size_t kMaxToken = 64;
constexpr std::int64_t kMaxGrace = 3'600'000;  // ms

std::string toHex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return text;
}

std::optional<std::string> fromHex(std::string_view text) {
  if (text.empty() || text.size() % 2 != 0 || text.size() > 2 * kMaxToken) return std::nullopt;
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    unsigned byte = 0;
    const auto [end, error] = std::from_chars(&text[i], &text[i] + 2, byte, 16);
    if (error != std::errc() || end != &text[i] + 2) return std::nullopt;
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

/// The value of the next line, which must begin with `key` and a blank.
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
  if (!value) return std::nullopt;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value->data(), value->data() + value->size(), number);
  if (error != std::errc() || end != value->data() + value->size() || number < 0) return std::nullopt;
  return number;
}

}  // namespace

std::optional<std::string> writeSavedSession(const SavedSession& session) {
  const auto millis = [](auto time) {
    return std::to_string(std::chrono::floor<std::chrono::milliseconds>(time).count());
  };
  std::string text = std::string(kFirstLine) + "\nserver " + session.server + "\nkey " + session.key.text() +
                     "\nname " + session.name + "\ntoken " + toHex(session.token) + "\ngrace " +
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
  auto bytes = fromHex(*token);
  constexpr std::int64_t kLatest = std::int64_t{1} << 42;  // ms; later ones do not fit the clock's type
  if (!fingerprint || !bytes || *alive > kLatest) return std::nullopt;
  return SavedSession{std::string(*server),
                      *fingerprint,
                      std::string(*name),
                      std::move(*bytes),
                      std::chrono::milliseconds(*grace),
                      SavedSession::Time(std::chrono::milliseconds(*alive))};
}

}  // namespace naiad
