#include "host/scores/ScoreKeeper.h"

#include <chrono>
#include <utility>

namespace naiad {

namespace {

constexpr const char* kScoreFile = "scores.sqlite3";

std::int64_t wallClock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(now).count();
}

}  // namespace

ScoreKeeper::ScoreKeeper(const std::filesystem::path& folder, std::string game, Clock clock)
    : m_clock(std::move(clock)) {
  if (folder.empty()) return;
  m_store = std::make_unique<ScoreStore>(folder / kScoreFile, std::move(game));
  try {
    for (const ScoreRow& row : m_store->best("", df::HighScoreLimits::kMaxRows)) {
      m_tables.addStored(row.table, row.name, row.points);
      m_loaded.insert({row.round, row.tick, row.number});
    }
  } catch (const StateFileError& error) {
    m_store.reset();
    setProblem(std::string(error.what()) + " Scores are lost when the server stops.");
  }
}

ScoreKeeper::ScoreKeeper(const std::filesystem::path& folder, std::string game)
    : ScoreKeeper(folder, std::move(game), wallClock) {}

ScoreKeeper::~ScoreKeeper() {
  finish();
}

void ScoreKeeper::add(const std::string& round, const std::vector<df::AddedScore>& scores,
                      const std::string& recording) {
  if (scores.empty()) return;
  std::vector<ScoreRow> rows;
  for (const df::AddedScore& added : scores) {
    if (m_loaded.contains({round, added.tick, added.number})) continue;
    if (!m_tables.addStored(added.table, added.score.name, added.score.points)) {
      ++m_refused;
      continue;
    }
    ++m_added;
    rows.push_back({added.table, df::scoreName(added.score.name), added.score.points, m_clock(), round,
                    added.tick, added.number, recording});
  }
  if (m_observer) {
    for (const ScoreRow& row : rows) m_observer(row);
  }
  if (m_store == nullptr || rows.empty()) return;
  const std::lock_guard lock(m_mutex);
  for (ScoreRow& row : rows) {
    if (m_waiting.size() < kMaxWaiting) {
      m_waiting.push_back(std::move(row));
    } else {
      ++m_dropped;
    }
  }
  if (!m_writing) m_writing = m_worker.enqueue([this] { write(); });
}

// Runs on the worker's thread. Continues with rows that were added while it wrote. Rows that could not be
// written are tried again with the next ones.
void ScoreKeeper::write() {
  std::unique_lock lock(m_mutex);
  while (!m_waiting.empty()) {
    const std::vector<ScoreRow> rows = std::exchange(m_waiting, {});
    lock.unlock();
    std::string problem;
    try {
      m_store->save(rows);
      m_written += rows.size();
    } catch (const StateFileError& error) {
      problem = error.what();
    }
    setProblem(problem);
    lock.lock();
    if (problem.empty()) continue;
    m_waiting.insert(m_waiting.begin(), rows.begin(), rows.end());
    break;
  }
  m_writing = false;
}

bool ScoreKeeper::read(const std::string& table, std::size_t count, Read done) {
  if (m_store == nullptr) return false;
  return m_worker.enqueue([this, table, count, done = std::move(done)] {
    write();
    try {
      done(m_store->best(table, count), "");
    } catch (const StateFileError& error) {
      done({}, error.what());
    }
  });
}

// Ignores a problem that was already reported.
void ScoreKeeper::setProblem(std::string problem) {
  const std::lock_guard lock(m_mutex);
  if (problem == m_problem) return;
  m_log_message = problem.empty() ? "scores can be written again" : "warning: " + problem;
  m_problem = std::move(problem);
  m_has_log_message = true;
}

std::string ScoreKeeper::popLogMessage() {
  if (!m_has_log_message) return "";
  const std::lock_guard lock(m_mutex);
  m_has_log_message = false;
  return std::exchange(m_log_message, "");
}

ScoreCounters ScoreKeeper::counters() const {
  return {m_added, m_refused, m_written, m_dropped};
}

void ScoreKeeper::finish() {
  if (m_store != nullptr) m_worker.enqueue([this] { write(); });
  m_worker.finish();
}

}  // namespace naiad
