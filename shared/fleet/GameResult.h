// A score of a server's game on the bus (HighScores.h): a row of a table, with what names it.
//
//   naiad.results.ID  {"v":1,"server":"berlin-9876","game":"tron","table":"rides","name":"Ann","points":143,
//                      "at":1800000000,"round":"…32 hexadecimal
//                      digits…","tick":4711,"number":0,"recording":""}
//
// messageId() names the row for JetStream, which keeps one of each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

struct GameResult {
  std::string server;  ///< ServerId.h
  std::string game;
  std::string table;
  std::string name;  ///< of the player
  std::int64_t points = 0;
  std::int64_t at = 0;  ///< seconds since 1970
  std::string round;
  std::uint32_t tick = 0;
  int number = 0;
  std::string recording;  ///< empty: there is none

  std::string payload() const;
  /// "ROUND-TICK-NUMBER".
  std::string messageId() const;
  /// Nothing for what no server writes.
  static std::optional<GameResult> parse(std::string_view payload);

  friend bool operator==(const GameResult&, const GameResult&) = default;
};

}  // namespace naiad
