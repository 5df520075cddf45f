#include "host/scores/ScoreStore.h"

#include <set>
#include <utility>

namespace naiad {

namespace {

constexpr StateFile::Kind kFileOfScores{
    "score file", 0x4e616953,  // "NaiS"
    1,
    "CREATE TABLE scores(id INTEGER PRIMARY KEY, game TEXT NOT NULL, board TEXT NOT NULL, name TEXT NOT "
    "NULL, "
    "points INTEGER NOT NULL, at INTEGER NOT NULL, round TEXT NOT NULL, tick INTEGER NOT NULL, number "
    "INTEGER "
    "NOT NULL, recording TEXT NOT NULL, UNIQUE(round, tick, number)) STRICT; "
    "CREATE INDEX best ON scores(game, board, points DESC, id)",
    true};

constexpr const char* kBest =
    "SELECT board, name, points, at, round, tick, number, recording FROM scores WHERE game = ? AND board = ? "
    "ORDER BY points DESC, id LIMIT ?";
constexpr const char* kInsert =
    "INSERT OR IGNORE INTO scores(game, board, name, points, at, round, tick, number, recording) "
    "VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr const char* kTrim =
    "DELETE FROM scores WHERE id IN (SELECT id FROM scores WHERE game = ? AND board = ? "
    "ORDER BY points DESC, id LIMIT -1 OFFSET ?)";

ScoreRow rowAt(const StateStatement& statement) {
  ScoreRow row;
  row.table = statement.text(0);
  row.name = statement.text(1);
  row.points = statement.number(2);
  row.at = statement.number(3);
  row.round = statement.text(4);
  row.tick = static_cast<std::uint32_t>(statement.number(5));
  row.number = static_cast<int>(statement.number(6));
  row.recording = statement.text(7);
  return row;
}

}  // namespace

ScoreStore::ScoreStore(std::filesystem::path file, std::string game)
    : m_file(std::move(file), kFileOfScores), m_game(std::move(game)) {}

std::vector<std::string> ScoreStore::tables() {
  StateStatement statement =
      m_file.prepare("SELECT DISTINCT board FROM scores WHERE game = ? ORDER BY board");
  statement.bind(1, m_game);
  std::vector<std::string> names;
  while (statement.step()) names.push_back(statement.text(0));
  if (!statement.isDone()) m_file.fail("cannot be read");
  return names;
}

std::vector<ScoreRow> ScoreStore::best(const std::string& table, std::size_t count) {
  if (!m_file.openExisting()) return {};
  std::vector<ScoreRow> rows;
  StateStatement statement = m_file.prepare(kBest);
  for (const std::string& name : table.empty() ? tables() : std::vector<std::string>{table}) {
    statement.reset();
    statement.bind(1, m_game);
    statement.bind(2, name);
    statement.bind(3, static_cast<std::int64_t>(count));
    while (statement.step()) rows.push_back(rowAt(statement));
    if (!statement.isDone()) m_file.fail("cannot be read");
  }
  return rows;
}

void ScoreStore::save(const std::vector<ScoreRow>& rows) {
  m_file.openOrCreate();
  m_file.run("BEGIN IMMEDIATE");
  try {
    insert(rows);
    std::set<std::string> changed;
    for (const ScoreRow& row : rows) changed.insert(row.table);
    for (const std::string& table : changed) trim(table);
    m_file.run("COMMIT");
  } catch (const StateFileError&) {
    try {
      m_file.run("ROLLBACK");
    } catch (const StateFileError&) {  // SQLite has already rolled back
    }
    throw;
  }
}

void ScoreStore::insert(const std::vector<ScoreRow>& rows) {
  StateStatement statement = m_file.prepare(kInsert);
  for (const ScoreRow& row : rows) {
    statement.reset();
    statement.bind(1, m_game);
    statement.bind(2, row.table);
    statement.bind(3, row.name);
    statement.bind(4, row.points);
    statement.bind(5, row.at);
    statement.bind(6, row.round);
    statement.bind(7, std::int64_t{row.tick});
    statement.bind(8, std::int64_t{row.number});
    statement.bind(9, row.recording);
    statement.step();
    if (!statement.isDone()) m_file.fail("cannot be written");
  }
}

// The query walks the index past kMaxRows rows. Only a few rows follow, because each save() trims.
void ScoreStore::trim(const std::string& table) {
  StateStatement statement = m_file.prepare(kTrim);
  statement.bind(1, m_game);
  statement.bind(2, table);
  statement.bind(3, static_cast<std::int64_t>(kMaxRows));
  statement.step();
  if (!statement.isDone()) m_file.fail("cannot be written");
}

}  // namespace naiad
