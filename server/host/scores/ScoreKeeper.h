// The best scores of a server's game: in memory for the start of each round, and persistent in a file.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/ScoreTables.h"
#include "host/scores/ScoreStore.h"
#include "shared/program/JobThread.h"

namespace naiad {

/// Counts the scores that worlds have added.
struct ScoreCounters {
  std::uint64_t added = 0;    ///< accepted scores
  std::uint64_t refused = 0;  ///< invalid scores, and those of more tables than a game may have
  std::uint64_t written = 0;  ///< saved on disk
  std::uint64_t dropped = 0;  ///< kept only in memory, because too many waited for the disk
};

/// Thread: the host's. A worker thread accesses the disk; only the constructor and finish() wait for it.
class ScoreKeeper {
 public:
  /// A wall clock: seconds since 1970.
  using Clock = std::function<std::int64_t()>;
  /// Maximum number of rows waiting for the disk. Further rows are lost when the server ends.
  static constexpr std::size_t kMaxWaiting = 4096;

  /// Uses the file scores.sqlite3 in `folder`; empty: no file, scores end with the server. A file that cannot
  /// be used is left unchanged, and popLogMessage() reports it.
  ScoreKeeper(const std::filesystem::path& folder, std::string game, Clock clock);
  ScoreKeeper(const std::filesystem::path& folder, std::string game);
  /// Calls finish().
  ~ScoreKeeper();

  /// Returns the tables that a world gets at its start.
  const std::map<std::string, std::vector<df::HighScore>>& tables() const { return m_tables.all(); }
  /// Sets the callback for each accepted row, called on the host's thread before the row is written.
  void setObserver(std::function<void(const ScoreRow& row)> observer) { m_observer = std::move(observer); }
  /// Adds scores of a world's round. The world may be untrusted, so all values are checked. A replayed round
  /// reports its scores again; those loaded from the file are ignored. `recording`: the round's file name.
  void add(const std::string& round, const std::vector<df::AddedScore>& scores,
           const std::string& recording = "");

  /// Called on the worker's thread with rows of the file, or with the reason why it cannot be read.
  using Read = std::function<void(const std::vector<ScoreRow>& rows, const std::string& problem)>;
  /// Writes the waiting rows, then reads like ScoreStore::best(). False if there is no file or too many jobs
  /// wait for the disk.
  bool read(const std::string& table, std::size_t count, Read done);
  /// True if there is a file that can be used.
  bool hasFile() const { return m_store != nullptr; }

  ScoreCounters counters() const;
  /// Returns a log line, once, if the file cannot be used or can be used again; else "".
  std::string popLogMessage();
  /// Waits until all rows are on disk or cannot be written. Later rows are not saved.
  void finish();

 private:
  void write();
  void setProblem(std::string problem);

  Clock m_clock;
  std::function<void(const ScoreRow&)> m_observer;
  df::ScoreTables m_tables;
  std::unique_ptr<ScoreStore> m_store;  ///< used only by the worker after the constructor
  std::set<std::tuple<std::string, std::uint32_t, int>>
      m_loaded;  ///< (round, tick, number) of the rows that were loaded from the file
  std::uint64_t m_added = 0;
  std::uint64_t m_refused = 0;
  std::uint64_t m_dropped = 0;
  std::atomic<std::uint64_t> m_written = 0;
  std::mutex m_mutex;               ///< guards the members below, except m_worker
  std::vector<ScoreRow> m_waiting;  ///< rows to write, oldest first
  bool m_writing = false;           ///< true if a job of the worker will write m_waiting
  std::string m_problem;            ///< current problem; empty: none
  std::string m_log_message;
  std::atomic<bool> m_has_log_message = false;
  JobThread m_worker;
};

}  // namespace naiad
