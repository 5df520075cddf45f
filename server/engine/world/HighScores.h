// Tables of best scores that outlive the game: dfserver stores them in a file and passes them to each round.
//
//   df::HighScores scores("arcade");
//   scores.add(p_player->getName(), p_player->getScore());
//   for (const df::HighScore& best : scores.best(3)) show(best.name, best.points);
//
// A HighScores only names a table of the current world, so make one wherever it is needed. Stored rows are in
// the table from the first tick on, not before GM.run(). Without a server, and in tests, tables begin empty
// and are lost with the world.
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

/// Gives access to a table by its name. Use it on the thread that runs the tick.
class HighScores : public HighScoreLimits {
 public:
  /// `table` is a name of 1 to 32 letters, digits, '-' and '_'.
  explicit HighScores(std::string table = "scores") : m_table(std::move(table)) {}
  const std::string& getTable() const { return m_table; }

  /// Adds a row. If fewer points are better, as for times, negate them. Returns 0, or −1 without effect for
  /// an invalid table name, an empty `name`, or above a limit of tables, points or rows added in this tick.
  int add(const std::string& name, std::int64_t points);
  /// Returns the `count` best rows (at most kMaxRows), best first. Of equal points, older rows come first.
  std::vector<HighScore> best(int count = 10) const;

 private:
  std::string m_table;
};

}  // namespace df
