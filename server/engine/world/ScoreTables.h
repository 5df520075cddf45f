// The tables of best scores of a world (HighScores.h), or of a server: what was kept, and what was added.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/world/HighScore.h"

namespace df {

/// A row that a game added. `tick` and `number` name it in its world: the same game with the same inputs adds
/// the same.
struct AddedScore {
  std::string table;
  HighScore score;
  std::uint32_t tick = 0;  ///< of the world, in which or after which it was added
  int number = 0;          ///< how many were added before it in that tick
};

class ScoreTables {
 public:
  static constexpr int kMaxNumber = 255;  ///< of AddedScore

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
  void beginTick(std::uint32_t tick);
  void endTick() { m_finished = m_added.size(); }

 private:
  bool insert(const std::string& table, HighScore score);

  std::map<std::string, std::vector<HighScore>> m_tables;
  std::vector<AddedScore> m_added;
  std::uint32_t m_tick = 0;
  int m_number = 0;
  std::size_t m_finished = 0;  ///< of these: before the end of the last tick
};

/// A player's name as a table has it: characters that no terminal draws in one cell are '?', and what is too
/// long is cut off.
std::string scoreName(const std::string& name);

}  // namespace df
