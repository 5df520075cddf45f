// A row of a table of best scores, and the limits of HighScores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace df {

/// A row of a table.
struct HighScore {
  std::string name;         ///< of the player, in UTF-8
  std::int64_t points = 0;  ///< more are better
  friend bool operator==(const HighScore& a, const HighScore& b) {
    return a.name == b.name && a.points == b.points;
  }
};

struct HighScoreLimits {
  static constexpr std::size_t kMaxTables = 16;       ///< of a game
  static constexpr std::size_t kMaxTableName = 32;    ///< characters
  static constexpr std::size_t kMaxName = 16;         ///< characters of a player's name; the rest is cut off
  static constexpr std::size_t kMaxRows = 100;        ///< that a world knows; the server's file has more
  static constexpr std::size_t kMaxAddedInTick = 16;  ///< in all tables together
  static constexpr std::int64_t kMaxPoints = 1'000'000'000'000'000;  ///< and as many below zero
};

}  // namespace df
