// Scores in memory and on disk: no written score is lost, and none is stored twice.
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/scores/ScoreKeeper.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Adds scores as a world does in this tick.
void addAll(ScoreKeeper& keeper, const std::string& round, std::uint32_t tick,
            std::vector<df::AddedScore> scores) {
  for (df::AddedScore& score : scores) {
    score.tick = tick;
    score.number = static_cast<int>(&score - scores.data());
  }
  keeper.add(round, scores, "round.dfr");
}

class ScoreKeeperTest : public testing::Test {
 protected:
  static df::AddedScore of(const std::string& name, std::int64_t points,
                           const std::string& table = "arcade") {
    return {table, {name, points}};
  }
  std::vector<ScoreRow> stored(const std::string& table = "", std::size_t count = 100'000) const {
    return ScoreStore(folder / "scores.sqlite3", "game").best(table, count);
  }
  std::string content() const { return test::contentOf(folder / "scores.sqlite3"); }

  const test::TempFolder folder;
};

TEST_F(ScoreKeeperTest, NextServerLoadsTheScores) {
  {
    ScoreKeeper keeper(folder, "game", [] { return 1'800'000'000; });
    addAll(keeper, "round", 7, {of("ann", 5), of("bob", 9), of("eve", -3, "other")});
    EXPECT_EQ(keeper.tables().at("arcade").front(), (df::HighScore{"bob", 9})) << "at once";
  }
  const ScoreKeeper keeper(folder, "game");
  EXPECT_EQ(keeper.tables().at("arcade"), (std::vector<df::HighScore>{{"bob", 9}, {"ann", 5}}));
  EXPECT_EQ(keeper.tables().at("other"), (std::vector<df::HighScore>{{"eve", -3}}));
  const auto rows = stored();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].name, "bob");
  EXPECT_EQ(rows[0].round, "round");
  EXPECT_EQ(rows[0].tick, 7u);
  EXPECT_EQ(rows[0].number, 1);
  EXPECT_EQ(rows[0].at, 1'800'000'000);
  EXPECT_EQ(rows[0].recording, "round.dfr");
  EXPECT_EQ(test::modeOf(folder / "scores.sqlite3"), 0600u);
}

TEST_F(ScoreKeeperTest, EachGameHasItsOwnScores) {
  {
    ScoreKeeper keeper(folder, "game");
    addAll(keeper, "r", 1, {of("ann", 5)});
  }
  {
    ScoreKeeper keeper(folder, "other");
    addAll(keeper, "s", 1, {of("bob", 9)});
  }
  EXPECT_EQ(ScoreKeeper(folder, "game").tables().at("arcade"), (std::vector<df::HighScore>{{"ann", 5}}));
}

TEST_F(ScoreKeeperTest, DuplicateScoreRowIsStoredOnce) {
  for (int times = 0; times < 3; ++times) {
    ScoreKeeper keeper(folder, "game");
    addAll(keeper, "round", 7, {of("ann", 5), of("ann", 5)});
  }
  EXPECT_EQ(stored().size(), 2u) << "two in one tick are two";
  EXPECT_EQ(ScoreKeeper(folder, "game").tables().at("arcade").size(), 2u);
  ScoreKeeper keeper(folder, "game");
  addAll(keeper, "round", 7, {of("ann", 5), of("ann", 5), of("bob", 1)});
  EXPECT_EQ(keeper.tables().at("arcade").size(), 3u) << "of a round that goes on the new one counts";
  EXPECT_EQ(keeper.counters().added, 1u);
}

TEST_F(ScoreKeeperTest, StoredTableKeepsTheBestTenThousandRows) {
  std::vector<ScoreRow> rows;
  for (int i = 0; i < 10'050; ++i)
    rows.push_back({"arcade", "ann", (i * 7919) % 10'050, 0, "round", static_cast<std::uint32_t>(i), 0});
  ScoreStore store(folder / "scores.sqlite3", "game");
  store.save(rows);
  store.save({{"other", "bob", -1, 0, "round", 0, 1}});
  const auto kept = stored("arcade");
  ASSERT_EQ(kept.size(), 10'000u);
  EXPECT_EQ(kept.front().points, 10'049);
  EXPECT_EQ(kept.back().points, 50);
  EXPECT_EQ(stored("other").size(), 1u);
  EXPECT_EQ(stored("", 3).size(), 4u) << "three of a table";
}

TEST_F(ScoreKeeperTest, InvalidAndExcessScoresAreRejected) {
  ScoreKeeper keeper(folder, "game");
  for (std::uint32_t t = 0; t < 100; ++t) addAll(keeper, "round", t, {of("ann", 1, "t" + std::to_string(t))});
  addAll(keeper, "round", 100,
         {of("", 1, "t1"), of("ann", 1, "no table"), of("ann", df::HighScoreLimits::kMaxPoints + 1, "t1")});
  addAll(keeper, "round", 101, {of("a\nb\x1b[2J and a very long name", 2, "t1")});
  keeper.finish();
  EXPECT_EQ(keeper.tables().size(), 16u);
  EXPECT_EQ(keeper.counters().refused, 84u + 3u);
  EXPECT_EQ(keeper.counters().added, 17u);
  EXPECT_EQ(keeper.counters().written, 17u);
  EXPECT_EQ(stored("t1").front().name, "a?b?[2J and a ve");
}

TEST_F(ScoreKeeperTest, UnusableFileIsReportedOnceAndLeftUnchanged) {
  for (const std::string& bytes : {std::string("no database"), std::string()}) {
    std::ofstream(folder / "scores.sqlite3", std::ios::binary) << bytes;
    ScoreKeeper keeper(folder, "game");
    const std::string news = keeper.popLogMessage();
    EXPECT_TRUE(test::has(news, "warning: The score file"));
    EXPECT_EQ(keeper.popLogMessage(), "");
    EXPECT_FALSE(keeper.hasFile());
    EXPECT_FALSE(keeper.read("", 10, [](const auto&, const auto&) { FAIL(); }));
    addAll(keeper, "round", 1, {of("ann", 5)});
    EXPECT_EQ(keeper.tables().at("arcade").size(), 1u) << "until the server ends";
    keeper.finish();
    EXPECT_EQ(content(), bytes);
  }
}

TEST_F(ScoreKeeperTest, ScoresWithoutAFolderStayInMemory) {
  ScoreKeeper keeper({}, "game");
  addAll(keeper, "round", 1, {of("ann", 5)});
  EXPECT_EQ(keeper.tables().at("arcade").size(), 1u);
  EXPECT_EQ(keeper.popLogMessage(), "");
}

class Blocker {
 public:
  explicit Blocker(const fs::path& file) {
    sqlite3_open(file.c_str(), &m_p_database);
    sqlite3_exec(m_p_database, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr);
  }
  ~Blocker() { release(); }
  void release() { sqlite3_close(std::exchange(m_p_database, nullptr)); }

 private:
  sqlite3* m_p_database = nullptr;
};

TEST_F(ScoreKeeperTest, LockedFileQueuesScoresUntilItIsFree) {
  ScoreKeeper keeper(folder, "game");
  addAll(keeper, "round", 0, {of("ann", 0)});
  std::mutex mutex;
  std::condition_variable read;
  int reads = 0;
  std::string problem;
  const auto sync = [&] {
    std::unique_lock lock(mutex);
    const int before = reads;
    ASSERT_TRUE(keeper.read("", 1, [&](const auto&, const std::string& what) {
      const std::lock_guard guard(mutex);
      problem = what;
      ++reads;
      read.notify_one();
    }));
    ASSERT_TRUE(read.wait_for(lock, 60s, [&] { return reads > before; }));
  };
  sync();
  EXPECT_EQ(keeper.counters().written, 1u);
  {
    Blocker blocker(folder / "scores.sqlite3");
    for (std::uint32_t t = 1; t <= 5000; ++t) addAll(keeper, "round", t, {of("ann", t)});
    sync();  // a write was tried
    EXPECT_EQ(keeper.counters().written, 1u);
    EXPECT_TRUE(test::has(keeper.popLogMessage(), "cannot be written"));
    EXPECT_EQ(problem, "") << "readers do not wait for writers";
  }
  const std::uint64_t dropped = keeper.counters().dropped;
  EXPECT_LE(dropped, 5000u - ScoreKeeper::kMaxWaiting) << "some may have been with the writer";
  sync();
  EXPECT_EQ(keeper.popLogMessage(), "scores can be written again");
  EXPECT_EQ(keeper.counters().written, 5001u - dropped);
  keeper.finish();
  EXPECT_EQ(stored().size(), 5001u - dropped);
}

/// Adds three rows per tick forever, and writes to the pipe how many are on disk.
[[noreturn]] void addWithoutEnd(const fs::path& folder, const std::string& round, int pipe) {
  ScoreKeeper keeper(folder, "game");
  for (std::uint32_t tick = 0;; ++tick) {
    addAll(keeper, round, tick,
           {{"arcade", {"ann", tick}}, {"arcade", {"ann", tick}}, {"arcade", {"bob", tick}}});
    std::uint64_t written = 0;
    while ((written = keeper.counters().written) < 3 * std::uint64_t{tick}) std::this_thread::yield();
    if (::write(pipe, &written, sizeof written) != sizeof written) _exit(1);
  }
}

/// Kills a process that runs addWithoutEnd() after `words` reports. Returns the last reported number of rows
/// on disk.
std::uint64_t killAfter(int words, const fs::path& folder, const std::string& round) {
  int ends[2] = {-1, -1};
  if (::pipe(ends) != 0) return 0;
  const pid_t child = ::fork();
  if (child == 0) addWithoutEnd(folder, round, ends[1]);
  ::close(ends[1]);
  std::uint64_t written = 0;
  for (int i = 0; i<words&& ::read(ends[0], &written, sizeof written)> 0; ++i) {
  }
  ::kill(child, SIGKILL);
  while (::read(ends[0], &written, sizeof written) > 0) {
  }
  ::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  return written;
}

TEST_F(ScoreKeeperTest, HundredKillsNeitherLoseNorDuplicateWrittenScores) {
  std::map<std::string, std::uint64_t> written;
  for (int kill = 0; kill < 100; ++kill) {
    const std::string round = "round " + std::to_string(kill);
    written[round] = killAfter(1 + kill % 5, folder, round);
  }
  std::map<std::string, std::set<std::pair<std::uint32_t, int>>> found;
  for (const ScoreRow& row : stored())
    EXPECT_TRUE(found[row.round].insert({row.tick, row.number}).second) << "none twice";
  ASSERT_LT(stored().size(), ScoreStore::kMaxRows) << "or the least have gone";
  for (const auto& [round, count] : written) EXPECT_GE(found[round].size(), count) << round;
  EXPECT_GT(written["round 4"], 0u);
}

}  // namespace
}  // namespace naiad
