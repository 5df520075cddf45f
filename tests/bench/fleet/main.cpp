// A fleet on this machine, whose servers and bus are killed while players play. Run by deploy/bench fleet.
//
//   naiad_fleet BOTS KILLS BUS_SECONDS HZ [SERVERS]   one line
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "Crowd.h"
#include "Fleet.h"
#include "shared/program/ProcessSetup.h"
#include "tests/bench/Guarded.h"
#include "tests/bench/Percentile.h"

namespace {

using namespace std::chrono_literals;
using bench::percentile;

/// Time after which a service manager restarts a server.
constexpr std::chrono::milliseconds kRestart{300};
constexpr std::chrono::milliseconds kPlay{2'000};  ///< time between two kills
constexpr std::chrono::milliseconds kReturnTimeout{60'000};
constexpr int kJoiningAtOnce = 25;

// Limits that a run must meet if the machine keeps up with the ticks.

constexpr double kMaxLatePercent = 5;  ///< if more ticks are late, the run is invalid
constexpr long kMaxBackMillis = 3'000;
constexpr long kMaxRedirectMillis = 2'000;  ///< limit of the 99th percentile

/// Returns the number of threads for these players. Each can serve at most 250 in time.
int threadsFor(int players) {
  return std::min(players, std::max(4, (players + 249) / 250));
}

struct Result {
  int kills = 0;
  int players = 0;    ///< players of killed servers
  int returned = 0;   ///< of these, players that play again as the same players
  int disturbed = 0;  ///< how often players of other servers lost their servers
  std::vector<long> back;
  std::vector<long> redirects;
  int lost_without_bus = 0;
};

void kill(bench::Fleet& fleet, bench::Crowd& crowd, std::size_t server, Result& result) {
  const int there = crowd.noteKill(fleet.port(server));
  fleet.killServer(server);
  std::this_thread::sleep_for(kRestart);
  fleet.startServer(server);
  crowd.waitUntilBack(kReturnTimeout);
  const bench::Crowd::Report came = crowd.report();
  ++result.kills;
  result.players += there;
  result.returned += came.returned;
  result.disturbed += came.disturbed;
  result.back.insert(result.back.end(), came.back.begin(), came.back.end());
}

void loseBus(bench::Fleet& fleet, bench::Crowd& crowd, std::chrono::seconds time, Result& result) {
  const int before = crowd.report().losses;
  fleet.killBus();
  std::this_thread::sleep_for(time);
  fleet.startBus();
  std::this_thread::sleep_for(5s);
  result.lost_without_bus = crowd.report().losses - before;
}

/// True if the directory redirected all players, and all that lost their server play again.
bool isComplete(const bench::FleetSetup& setup, const Result& result) {
  return static_cast<int>(result.back.size()) == result.players &&
         static_cast<int>(result.redirects.size()) == setup.bots;
}

bool isGood(const Result& result) {
  return result.returned == result.players && percentile(result.back, 100) <= kMaxBackMillis &&
         percentile(result.redirects, 99) <= kMaxRedirectMillis && result.disturbed == 0 &&
         result.lost_without_bus == 0;
}

/// Prints the result. False if the run failed.
bool print(const bench::FleetSetup& setup, const Result& result, std::chrono::seconds bus_time,
           const bench::Fleet::Ticks& ticks) {
  const double late =
      ticks.all > 0 ? 100.0 * static_cast<double>(ticks.late) / static_cast<double>(ticks.all) : 100;
  const bool is_valid = late <= kMaxLatePercent;
  const bool failed = !isComplete(setup, result) || (is_valid && !isGood(result));
  std::printf(
      "fleet bots=%d servers=%d hz=%d kills=%d players=%d back=%zu returned=%d p50_ms=%ld p99_ms=%ld "
      "max_ms=%ld "
      "redirects=%zu redirect_p50_ms=%ld redirect_p99_ms=%ld redirect_max_ms=%ld disturbed=%d "
      "bus_seconds=%lld bus_lost=%d ticks=%llu "
      "late_percent=%.2f valid=%d failed=%d\n",
      setup.bots, setup.servers, setup.hz, result.kills, result.players, result.back.size(), result.returned,
      percentile(result.back, 50), percentile(result.back, 99), percentile(result.back, 100),
      result.redirects.size(), percentile(result.redirects, 50), percentile(result.redirects, 99),
      percentile(result.redirects, 100), result.disturbed, static_cast<long long>(bus_time.count()),
      result.lost_without_bus, static_cast<unsigned long long>(ticks.all), late, is_valid ? 1 : 0,
      failed ? 1 : 0);
  return !failed;
}

int run(const bench::FleetSetup& setup, int kills, std::chrono::seconds bus_time) {
  bench::Fleet fleet(setup);
  std::fprintf(stderr, "naiad_fleet: %zu servers\n", fleet.size());
  bench::Crowd crowd(fleet.link(), fleet.folder(), setup.bots, threadsFor(setup.bots));
  Result result;
  if (!crowd.joinAll(kJoiningAtOnce, 300s)) {
    std::printf("fleet bots=%d servers=%d joined=%d failed=1\n", setup.bots, setup.servers,
                crowd.report().playing);
    return 1;
  }
  result.redirects = crowd.report().redirects;
  std::fprintf(stderr, "naiad_fleet: %d players play\n", setup.bots);
  std::mt19937_64 random(1);
  for (int i = 0; i < kills; ++i) {
    std::this_thread::sleep_for(kPlay);
    kill(fleet, crowd, random() % fleet.size(), result);
    std::fprintf(stderr, "naiad_fleet: kill %d of %d, %d play\n", i + 1, kills, crowd.report().playing);
  }
  if (bus_time.count() > 0) loseBus(fleet, crowd, bus_time, result);
  crowd.leaveAll();
  fleet.end();
  return print(setup, result, bus_time, fleet.ticks()) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() != 4 && words.size() != 5) {
    std::fprintf(stderr, "usage: naiad_fleet BOTS KILLS BUS_SECONDS HZ [SERVERS]\n");
    return 2;
  }
  bench::FleetSetup setup;
  setup.bots = std::atoi(words[0].c_str());
  setup.hz = std::atoi(words[3].c_str());
  if (words.size() == 5) setup.servers = std::atoi(words[4].c_str());
  // A quarter of the slots stays free, so that players fit when servers are killed.
  setup.max_players = setup.bots / setup.servers * 4 / 3 + 4;
  naiad::ignoreBrokenPipes();
  naiad::raiseOpenFileLimit(static_cast<std::size_t>(4 * setup.bots + 256));
  return bench::guarded("naiad_fleet", [&] {
    return run(setup, std::atoi(words[1].c_str()), std::chrono::seconds(std::atoi(words[2].c_str())));
  });
}
