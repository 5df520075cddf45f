// The best scores of a server's game: in memory, from where each round begins, and in a file, where they
// last.
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
#include "host/admin/AdminWorker.h"
#include "host/scores/ScoreStore.h"

namespace naiad {

/// What became of the scores that worlds have added.
struct ScoreCounters {
  std::uint64_t added = 0;    ///< taken over
  std::uint64_t refused = 0;  ///< no good, or of more tables than a game may have
  std::uint64_t written = 0;  ///< on disk
  std::uint64_t dropped = 0;  ///< in memory alone: too many waited for the disk
};

/// The host's thread calls all of it; the disk has a thread of its own, and no call but the constructor's
/// waits for it.
class ScoreKeeper {
 public:
  /// A wall clock: seconds since 1970.
  using Clock = std::function<std::int64_t()>;
  /// Rows that wait for the disk, at most; those beyond hold until the server ends.
  static constexpr std::size_t kMaxWaiting = 4096;

  /// `folder`: of the file scores.sqlite3; empty: there is none, and scores end with the server. A file that
  /// cannot be used stays as it is, and takeNews() says so.
  ScoreKeeper(const std::filesystem::path& folder, std::string game, Clock clock);
  ScoreKeeper(const std::filesystem::path& folder, std::string game);
  /// As finish().
  ~ScoreKeeper();

  /// What a world is passed at its start.
  const std::map<std::string, std::vector<df::HighScore>>& tables() const { return m_tables.all(); }
  /// Gets each row that is taken over, before it is written. On the host's thread.
  void setObserver(std::function<void(const ScoreRow& row)> observer) { m_observer = std::move(observer); }
  /// A world has added these in its round. It may be a stranger's program: all is checked. Of a round that
  /// is executed again they may come again, and count once. `recording`: the name of its file.
  void add(const std::string& round, const std::vector<df::AddedScore>& scores,
           const std::string& recording = "");

  /// Rows of the file, with those that waited for it until now, or why it cannot be read. On the worker's
  /// thread.
  using Read = std::function<void(const std::vector<ScoreRow>& rows, const std::string& problem)>;
  /// As ScoreStore::best(). False: too much waits for the disk.
  bool read(const std::string& table, std::size_t count, Read done);
  /// Is there a file that can be used?
  bool hasFile() const { return m_store != nullptr; }

  ScoreCounters counters() const;
  /// A line for the log, if there is news of the file: it cannot be used, or can be again.
  std::string takeNews();
  /// Wait until what was added is on disk, or cannot be written. Nothing is taken after this.
  void finish();

 private:
  void write();
  void note(std::string problem);

  Clock m_clock;
  std::function<void(const ScoreRow&)> m_observer;
  df::ScoreTables m_tables;
  std::unique_ptr<ScoreStore> m_store;  ///< the worker's, after the constructor
  std::set<std::tuple<std::string, std::uint32_t, int>>
      m_loaded;  ///< what names rows of the file in m_tables
  std::uint64_t m_added = 0;
  std::uint64_t m_refused = 0;
  std::uint64_t m_dropped = 0;
  std::atomic<std::uint64_t> m_written = 0;
  std::mutex m_mutex;               ///< of all that follows, but the worker
  std::vector<ScoreRow> m_waiting;  ///< in the order in which they came
  bool m_writing = false;           ///< a job of the worker will see to those
  std::string m_problem;            ///< the last one that was noted; empty: none since
  std::string m_news;
  std::atomic<bool> m_has_news = false;
  AdminWorker m_worker;
};

}  // namespace naiad
