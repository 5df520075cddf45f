// Kills dfserver while clients play its game, and measures the cost of a journal. Run by deploy/bench
// recovery.
//
//   naiad_recovery kills GAME COUNT    one line: the results of this many kills
//   naiad_recovery long GAME COUNT     kills in a round of ten minutes
//   naiad_recovery scores COUNT        kills in a game that adds scores, which the server must keep
//   naiad_recovery worlds GAME COUNT   kills of the world's process while the server lives
//   naiad_recovery hangs COUNT         hangs of worlds, with the server's own --tick-timeout
//   naiad_recovery journal GAME TICKS  a line each: size of a journal, cost of a tick, verifying it
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "JournalCost.h"
#include "RecoveryRun.h"
#include "server/replay/RecordedRound.h"
#include "server/replay/Verify.h"
#include "tests/bench/Guarded.h"
#include "tests/bench/Percentile.h"
#include "tests/server/replay/Recorder.h"

namespace {

using bench::percentile;
using naiad::test::KillResult;
using naiad::test::RecoveryRun;
using std::chrono::milliseconds;

constexpr int kPlayers = 4;
constexpr std::uint64_t kSeed = 1;
constexpr const char* kHangingModule = NAIAD_BINARY_DIR "/../lib/hanging_module.so";
/// Kills per round. They are limited, because each compares pictures by replaying the round from its
/// beginning.
constexpr int kKillsInARound = 10;
constexpr milliseconds kMaxPlay{1500};
/// The number of ticks in ten minutes at 30 Hz. Here a tick takes only 2 ms.
constexpr std::uint32_t kLongTurns = 18'000;
constexpr std::chrono::microseconds kShortFrame{2'000};
constexpr std::chrono::microseconds kFrame{33'333};
constexpr std::chrono::seconds kReplayTimeout{300};
/// Time between two kills of a world. Two within a second would end the round.
constexpr milliseconds kBetweenDeaths{1500};
constexpr milliseconds kBetweenCopies{10'000};

struct Total {
  int kills = 0;
  int players = 0;
  int returned = 0;
  std::uint64_t ticks_lost = 0;
  std::uint64_t cells = 0;
  std::uint64_t wrong_cells = 0;
  int verified = 0;
  int rounds = 0;
  std::size_t scores = 0;
  std::size_t missing = 0;
  std::size_t foreign = 0;
  std::vector<long> took;  ///< times until all players were back, in milliseconds
};

void add(const KillResult& result, Total& total) {
  ++total.kills;
  total.players += result.players;
  total.returned += result.returned;
  total.ticks_lost += result.ticks_lost;
  total.cells += result.cells;
  total.wrong_cells += result.wrong_cells;
  total.took.push_back(result.took.count());
  if (!result.problem.empty()) std::fprintf(stderr, "naiad_recovery: %s\n", result.problem.c_str());
}

/// Ends a round, and counts it if its replay is equal.
int countVerified(RecoveryRun& run) {
  std::string said;
  if (run.verify(said)) return 1;
  std::fprintf(stderr, "naiad_recovery: %s\n%s\n", said.c_str(), run.log().c_str());
  return 0;
}

void verify(RecoveryRun& run, const std::string& game, Total& total) {
  ++total.rounds;
  total.verified += countVerified(run);
  if (game != naiad::test::kScoresModule) return;
  const naiad::test::ScoreCheck check = run.checkScores();
  total.scores += check.kept;
  total.missing += check.missing;
  total.foreign += check.foreign;
}

/// Kills the server, in some cases also its world before it, or its successor after it.
KillResult killSomehow(RecoveryRun& run, std::mt19937_64& random) {
  switch (random() % 4) {
    case 0:
      return run.killBoth();
    case 1:
      // The second kill is while the server is starting, or while clients return.
      return run.killTwice(milliseconds(random() % 700));
    default:
      return run.kill();
  }
}

/// Runs a round with kills and verifies it at the end.
void runRound(const std::string& game, int kills, std::mt19937_64& random, Total& total) {
  RecoveryRun run(game, kPlayers, random(), kFrame);
  for (int i = 0; i < kills; ++i) {
    run.play(milliseconds(random() % static_cast<std::uint64_t>(kMaxPlay.count())));
    const KillResult result = killSomehow(run, random);
    add(result, total);
    if (result.returned < result.players) return;
  }
  verify(run, game, total);
}

/// Kills in a round of ten minutes. The whole round is replayed after each kill.
Total runLongRound(const std::string& game, int kills) {
  Total total;
  RecoveryRun run(game, kPlayers, kSeed, kShortFrame);
  if (!run.playUntilTurn(kLongTurns, kReplayTimeout)) throw std::runtime_error("the round does not get on");
  for (int i = 0; i < kills; ++i) {
    run.play(milliseconds(300));
    add(run.kill(), total);
  }
  verify(run, game, total);
  return total;
}

int report(const char* suite, const std::string& game, const Total& total) {
  std::printf(
      "%s game=%s kills=%d players=%d returned=%d ticks_lost=%llu compared_cells=%llu wrong_cells=%llu "
      "p50_ms=%ld p99_ms=%ld rounds=%d verified=%d\n",
      suite, game.c_str(), total.kills, total.players, total.returned,
      static_cast<unsigned long long>(total.ticks_lost), static_cast<unsigned long long>(total.cells),
      static_cast<unsigned long long>(total.wrong_cells), percentile(total.took, 50),
      percentile(total.took, 99), total.rounds, total.verified);
  const bool good = total.returned == total.players && total.ticks_lost == 0 && total.wrong_cells == 0 &&
                    total.verified == total.rounds;
  return good ? 0 : 1;
}

Total killAll(const std::string& game, int count) {
  std::mt19937_64 random(kSeed);
  Total total;
  while (total.kills < count) runRound(game, std::min(kKillsInARound, count - total.kills), random, total);
  return total;
}

int scores(int count) {
  const Total total = killAll(naiad::test::kScoresModule, count);
  const bool good = total.scores > 0 && total.missing == 0 && total.foreign == 0 &&
                    total.verified == total.rounds && total.returned == total.players;
  std::printf(
      "scores kills=%d players=%d returned=%d scores=%zu missing=%zu foreign=%zu rounds=%d verified=%d%s\n",
      total.kills, total.players, total.returned, total.scores, total.missing, total.foreign, total.rounds,
      total.verified, good ? "" : " failed=1");
  return good ? 0 : 1;
}

/// Returns a time up to that between two copies of a world.
milliseconds anyMoment(std::mt19937_64& random) {
  return milliseconds(random() % static_cast<std::uint64_t>(kBetweenCopies.count()));
}

/// Kills worlds of one round at any time since their newest copy.
int worlds(const std::string& game, int count) {
  std::mt19937_64 random(kSeed);
  std::vector<long> took;
  RecoveryRun run(game, kPlayers, random(), kFrame);
  for (int i = 0; i < count; ++i) {
    run.play(kBetweenDeaths + anyMoment(random));
    const auto time = run.killWorld();
    if (!time) break;
    took.push_back(time->count());
  }
  const int verified = countVerified(run);
  std::printf("take_over game=%s kills=%d went_on=%zu p50_ms=%ld p99_ms=%ld verified=%d\n", game.c_str(),
              count, took.size(), percentile(took, 50), percentile(took, 99), verified);
  return static_cast<int>(took.size()) == count && verified == 1 ? 0 : 1;
}

/// Tests the first hang of each round, some seconds after the newest copy.
int hangs(int count) {
  std::mt19937_64 random(kSeed);
  std::vector<long> took;
  int verified = 0;
  for (int i = 0; i < count; ++i) {
    RecoveryRun run(kHangingModule, kPlayers, random(), kFrame);
    run.play(kBetweenCopies + anyMoment(random));
    const auto time = run.hangWorld(df::Keyboard::H);
    if (!time) break;
    took.push_back(time->count());
    verified += countVerified(run);
  }
  std::printf("hangs hangs=%d went_on=%zu p50_ms=%ld max_ms=%ld verified=%d\n", count, took.size(),
              percentile(took, 50), percentile(took, 100), verified);
  return static_cast<int>(took.size()) == count && verified == count ? 0 : 1;
}

int journal(const std::string& game, std::uint32_t ticks) {
  naiad::Recorder recorder;
  const auto file = recorder.record({.game = game, .seed = 1, .ticks = ticks, .players = kPlayers});
  const double hours = ticks / 30.0 / 3600;
  std::printf("journal game=%s players=%d bytes_per_hour=%.0f ns_per_tick=%.0f\n", game.c_str(), kPlayers,
              static_cast<double>(std::filesystem::file_size(file)) / hours, bench::journalNanos(kPlayers));
  const naiad::RecordedRound round(file);
  const naiad::ReplayEnvironment stage(round, "");
  std::ostringstream said;
  const auto began = std::chrono::steady_clock::now();
  const bool same = naiad::verifyRound(round, stage, said);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  std::printf("verify game=%s ticks=%u times_real_time=%.0f%s\n", game.c_str(), ticks,
              ticks / 30.0 / took.count(), same ? "" : " failed=1");
  return same ? 0 : 1;
}

/// Returns the exit code; 2 for invalid arguments.
int start(const std::vector<std::string>& words) {
  const std::string what = words.empty() ? "" : words[0];
  const int count = words.empty() ? 0 : std::atoi(words.back().c_str());
  if (words.size() == 2 && what == "scores") return scores(count);
  if (words.size() == 2 && what == "hangs") return hangs(count);
  if (words.size() == 3 && what == "kills") return report("recovery", words[1], killAll(words[1], count));
  if (words.size() == 3 && what == "long")
    return report("long_round", words[1], runLongRound(words[1], count));
  if (words.size() == 3 && what == "worlds") return worlds(words[1], count);
  if (words.size() == 3 && what == "journal") return journal(words[1], static_cast<std::uint32_t>(count));
  std::fprintf(stderr, "usage: naiad_recovery scores|hangs COUNT | kills|long|worlds|journal GAME COUNT\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::guarded("naiad_recovery", [&] { return start({argv + 1, argv + argc}); });
}
