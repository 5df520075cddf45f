// Tables of best scores that outlive the game: dfserver stores them in a file and passes them to each round.
//
//   df::HighScores scores("arcade");
//   scores.add(p_player->getName(), p_player->getScore());
//   for (const df::HighScore& best : scores.best(3)) show(best.name, best.points);
//
// A HighScores only names a table of the current world, so make one wherever it is needed. Stored rows are
// there from the first tick on, not before GM.run(). Without a server, and in tests, the tables begin empty
// and end with the world.
//
// Stored rows are inputs of the world, like key presses, and added rows are part of its output. So a round
// that is replayed from its inputs shows the same tables.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "detail/HighScore.h"

namespace df {

/// Names a table. Call it on the thread that runs the tick.
class HighScores : public HighScoreLimits {
 public:
  /// `table` has 1 to 32 letters, digits, '-' and '_'.
  explicit HighScores(std::string table = "scores") : m_table(std::move(table)) {}
  const std::string& getTable() const { return m_table; }

  /// Adds a row. If less is better, as for times, add it negated. Returns 0, or −1 without effect for an
  /// invalid table name, an empty `name`, or more tables, points or rows in this tick than the limits allow.
  int add(const std::string& name, std::int64_t points);
  /// Returns the best rows, best first; of equal points, the older row first. At most kMaxRows.
  std::vector<HighScore> best(int count = 10) const;

 private:
  std::string m_table;
};

}  // namespace df
