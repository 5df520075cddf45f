// The tables of best scores of a world (HighScores.h), or of a server: what was kept, and what was added.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/world/HighScores.h"

namespace df {

/// A row that a game added.
struct AddedScore {
  std::string table;
  HighScore score;
};

class ScoreTables {
 public:
  /// A row that was kept before. False: there is no room for it, or it is none; nothing changes.
  bool keep(const std::string& table, const std::string& name, std::int64_t points);
  /// A row of this tick's. False: the same, or too many in this tick.
  bool add(const std::string& table, const std::string& name, std::int64_t points);
  /// The rows of a table, best first.
  const std::vector<HighScore>& rows(const std::string& table) const;
  const std::map<std::string, std::vector<HighScore>>& all() const { return m_tables; }

  /// What was added up to the end of the last tick, in that order. What is not taken before the next one
  /// begins is forgotten.
  std::vector<AddedScore> takeAdded();
  void beginTick();
  void endTick() { m_finished = m_added.size(); }

 private:
  bool insert(const std::string& table, HighScore score);

  std::map<std::string, std::vector<HighScore>> m_tables;
  std::vector<AddedScore> m_added;
  std::size_t m_finished = 0;  ///< of these: before the end of the last tick
};

/// A player's name as a table has it: characters that no terminal draws in one cell are '?', and what is too
/// long is cut off.
std::string scoreName(const std::string& name);

}  // namespace df
