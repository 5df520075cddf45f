// Tables of best scores that outlive the game: dfserver keeps them in a file, and passes them to each round.
//
//   df::HighScores scores("arcade");
//   scores.add(p_player->getName(), p_player->getScore());
//   for (const df::HighScore& best : scores.best(3)) show(best.name, best.points);
//
// A HighScores is a name for a table of the current world; the table has no more than that to do with it, so
// make one where it is needed. What the server has kept is there from the first tick on, not before GM.run().
// Without a server, and in tests, the tables begin empty and end with the world.
//
// What is kept is an input of the world, as a key press is, and what is added is part of its output. So a
// round that is played again from its inputs shows the same tables.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "detail/HighScore.h"

namespace df {

/// On the thread that runs the tick.
class HighScores : public HighScoreLimits {
 public:
  /// The game's table of this name: 1 to 32 letters, digits, '-' and '_'.
  explicit HighScores(std::string table = "scores") : m_table(std::move(table)) {}
  const std::string& getTable() const { return m_table; }

  /// Add a row. Where less is better, as of times, add it negated. Return 0; or −1, and nothing is added: for
  /// a name of the table that is none, more tables, rows in a tick or points than above, an empty `name`.
  int add(const std::string& name, std::int64_t points);
  /// The best rows, best first; of rows with as many points, the older first. At most kMaxRows.
  std::vector<HighScore> best(int count = 10) const;

 private:
  std::string m_table;
};

}  // namespace df
