// The tables of best scores of a world (HighScores.h) or of a server, with stored and newly added rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/world/HighScore.h"

namespace df {

/// A row that a game added. `tick` and `number` identify it in its world: a replay adds it with equal ones.
struct AddedScore {
  std::string table;
  HighScore score;
  std::uint32_t tick = 0;  ///< tick in which, or after which, the row was added
  int number = 0;          ///< number of rows added earlier in that tick
};

class ScoreTables {
 public:
  static constexpr int kMaxNumber = 255;  ///< highest AddedScore::number

  /// Adds a row that was stored before. Returns false, without change, for an invalid row or too many tables.
  bool addStored(const std::string& table, const std::string& name, std::int64_t points);
  /// Adds a row in this tick. Returns false like addStored(), or if too many rows were added in this tick.
  bool add(const std::string& table, const std::string& name, std::int64_t points);
  /// Returns the rows of a table, best first.
  const std::vector<HighScore>& rows(const std::string& table) const;
  const std::map<std::string, std::vector<HighScore>>& all() const { return m_tables; }

  /// Returns and removes the rows added so far, in order. The beginning of a tick also removes the rows that
  /// were added before the end of the tick before it.
  std::vector<AddedScore> popAdded();
  void beginTick(std::uint32_t tick);
  void endTick() { m_finished = m_added.size(); }

 private:
  bool insert(const std::string& table, HighScore score);

  std::map<std::string, std::vector<HighScore>> m_tables;
  std::vector<AddedScore> m_added;
  std::uint32_t m_tick = 0;
  int m_number = 0;
  std::size_t m_finished = 0;  ///< number of rows of m_added from before the end of the last tick
};

/// Returns a player's name in the form for tables: characters that no terminal draws in one cell become '?',
/// and names that are too long are truncated.
std::string scoreName(const std::string& name);

}  // namespace df
