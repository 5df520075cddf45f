// The tables of best scores of a world (HighScores.h) or of a server: stored rows and newly added ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/world/HighScore.h"

namespace df {

/// A row that a game added. `tick` and `number` identify it in its world: a replay adds it with these again.
struct AddedScore {
  std::string table;
  HighScore score;
  std::uint32_t tick = 0;  ///< tick of the world, in which or after which it was added
  int number = 0;          ///< number of rows added before it in that tick
};

class ScoreTables {
 public:
  static constexpr int kMaxNumber = 255;  ///< limit of AddedScore::number

  /// Adds a row that was stored before. False without change if it is invalid or there are too many tables.
  bool addStored(const std::string& table, const std::string& name, std::int64_t points);
  /// Adds a row of this tick. False as for addStored(), or if there are too many in this tick.
  bool add(const std::string& table, const std::string& name, std::int64_t points);
  /// Returns the rows of a table, best first.
  const std::vector<HighScore>& rows(const std::string& table) const;
  const std::map<std::string, std::vector<HighScore>>& all() const { return m_tables; }

  /// Returns the rows added up to the end of the last tick, in that order. What is not taken before the next
  /// tick begins is forgotten.
  std::vector<AddedScore> popAdded();
  void beginTick(std::uint32_t tick);
  void endTick() { m_finished = m_added.size(); }

 private:
  bool insert(const std::string& table, HighScore score);

  std::map<std::string, std::vector<HighScore>> m_tables;
  std::vector<AddedScore> m_added;
  std::uint32_t m_tick = 0;
  int m_number = 0;
  std::size_t m_finished = 0;  ///< number of m_added from before the end of the last tick
};

/// Returns a player's name as a table has it: characters that no terminal draws in one cell become '?', and
/// what is too long is truncated.
std::string scoreName(const std::string& name);

}  // namespace df
