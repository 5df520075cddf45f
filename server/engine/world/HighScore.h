// A row of a table of best scores, and the limits of HighScores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace df {

/// A row of a table.
struct HighScore {
  std::string name;         ///< name of the player, UTF-8
  std::int64_t points = 0;  ///< more is better
  friend bool operator==(const HighScore& a, const HighScore& b) {
    return a.name == b.name && a.points == b.points;
  }
};

/// Limits of the tables of a world.
struct HighScoreLimits {
  static constexpr std::size_t kMaxTables = 16;     ///< tables of a game
  static constexpr std::size_t kMaxTableName = 32;  ///< characters in a table's name
  static constexpr std::size_t kMaxName = 16;   ///< characters in a player's name; longer ones are truncated
  static constexpr std::size_t kMaxRows = 100;  ///< rows per table in a world; the server's file has more
  static constexpr std::size_t kMaxAddedInTick = 16;                 ///< rows added in a tick, in all tables
  static constexpr std::int64_t kMaxPoints = 1'000'000'000'000'000;  ///< the minimum is -kMaxPoints
};

}  // namespace df
