#include "engine/world/ScoreTables.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "shared/values/Canvas.h"

namespace df {

namespace {

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

bool isTableName(const std::string& table) {
  return !table.empty() && table.size() <= HighScoreLimits::kMaxTableName &&
         std::all_of(table.begin(), table.end(), isLetter);
}

bool isInRange(std::int64_t points) {
  return points >= -HighScoreLimits::kMaxPoints && points <= HighScoreLimits::kMaxPoints;
}

}  // namespace

std::string scoreName(const std::string& name) {
  std::string safe;
  std::size_t count = 0;
  for (const char32_t ch : decodeUtf8(name)) {
    if (++count > HighScoreLimits::kMaxName) break;
    appendUtf8(safe, isDrawable(ch) ? ch : U'?');
  }
  return safe;
}

// Inserts the row behind rows with equal points, which are older.
bool ScoreTables::insert(const std::string& table, HighScore score) {
  if (!isTableName(table) || score.name.empty() || !isInRange(score.points)) return false;
  if (m_tables.size() >= HighScoreLimits::kMaxTables && m_tables.count(table) == 0) return false;
  std::vector<HighScore>& rows = m_tables[table];
  const auto place =
      std::upper_bound(rows.begin(), rows.end(), score.points,
                       [](std::int64_t points, const HighScore& row) { return points > row.points; });
  if (place == rows.end() && rows.size() >= HighScoreLimits::kMaxRows) return true;
  rows.insert(place, std::move(score));
  if (rows.size() > HighScoreLimits::kMaxRows) rows.pop_back();
  return true;
}

bool ScoreTables::addStored(const std::string& table, const std::string& name, std::int64_t points) {
  return insert(table, {scoreName(name), points});
}

bool ScoreTables::add(const std::string& table, const std::string& name, std::int64_t points) {
  if (m_added.size() - m_finished >= HighScoreLimits::kMaxAddedInTick || m_number > kMaxNumber) return false;
  HighScore score{scoreName(name), points};
  if (!insert(table, score)) return false;
  m_added.push_back({table, std::move(score), m_tick, m_number++});
  return true;
}

const std::vector<HighScore>& ScoreTables::rows(const std::string& table) const {
  static const std::vector<HighScore> none;
  const auto found = m_tables.find(table);
  return found != m_tables.end() ? found->second : none;
}

std::vector<AddedScore> ScoreTables::popAdded() {
  m_finished = 0;
  return std::exchange(m_added, {});
}

void ScoreTables::beginTick(std::uint32_t tick) {
  m_tick = tick;
  m_number = 0;
  m_added.erase(m_added.begin(), m_added.begin() + static_cast<std::ptrdiff_t>(m_finished));
  m_finished = 0;
}

}  // namespace df
