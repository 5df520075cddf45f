#include "shared/fleet/GameResult.h"

#include <algorithm>
#include <limits>

#include "shared/fleet/BusFields.h"
#include "shared/fleet/ServerId.h"
#include "shared/json/Json.h"
#include "shared/net/base/Limits.h"

namespace naiad {

namespace {

constexpr std::int64_t kResultFormat = 1;
constexpr std::size_t kMaxGame = 64;
constexpr std::size_t kMaxTable = 32;                       // as HighScores.h has it
constexpr std::int64_t kMaxPoints = 1'000'000'000'000'000;  // the same
constexpr std::size_t kRoundDigits = 32;
constexpr std::size_t kMaxRecording = 128;
constexpr std::int64_t kLastSecond = 253'402'300'799;  // of the year 9999

bool isTable(const std::string& table) {
  return !table.empty() && std::all_of(table.begin(), table.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

bool isRound(const std::string& round) {
  return round.size() == kRoundDigits && std::all_of(round.begin(), round.end(), [](char c) {
           return (c >= 'a' && c <= 'f') || (c >= '0' && c <= '9');
         });
}

}  // namespace

std::string GameResult::payload() const {
  return Json{{"v", kResultFormat}, {"server", server},      {"game", game},
              {"table", table},     {"name", name},          {"points", points},
              {"at", at},           {"round", round},        {"tick", tick},
              {"number", number},   {"recording", recording}}
      .toString();
}

std::string GameResult::messageId() const {
  return round + "-" + std::to_string(tick) + "-" + std::to_string(number);
}

std::optional<GameResult> GameResult::parse(std::string_view payload) {
  BusFields fields(payload);
  GameResult result;
  fields.number("v", kResultFormat, kResultFormat);
  result.server = fields.word("server", kMaxServerId);
  result.game = fields.line("game", kMaxGame);
  result.table = fields.word("table", kMaxTable);
  result.name = fields.line("name", kMaxNameLength);
  result.points = fields.number("points", -kMaxPoints, kMaxPoints);
  result.at = fields.number("at", 0, kLastSecond);
  result.round = fields.word("round", kRoundDigits);
  result.tick =
      static_cast<std::uint32_t>(fields.number("tick", 0, std::numeric_limits<std::uint32_t>::max()));
  result.number = static_cast<int>(fields.number("number", 0, 255));
  result.recording = fields.word("recording", kMaxRecording);
  const bool good = fields.ok() && isServerId(result.server) && isTable(result.table) &&
                    !result.name.empty() && isRound(result.round);
  return good ? std::optional(result) : std::nullopt;
}

}  // namespace naiad
