// A fleet on this machine, whose servers and bus are killed while players play. deploy/bench fleet runs it.
//
//   naiad_fleet BOTS KILLS BUS_SECONDS HZ [SERVERS]   one line
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include "Bots.h"
#include "Fleet.h"
#include "shared/program/BrokenPipes.h"
#include "shared/program/OpenFiles.h"

namespace {

using namespace std::chrono_literals;
using Clock = bench::Bot::Clock;

/// After which a service manager starts a server again.
constexpr std::chrono::milliseconds kRestart{300};
constexpr std::chrono::milliseconds kPlay{2'000};  ///< between two kills
constexpr std::chrono::milliseconds kReturnTimeout{60'000};
constexpr int kJoiningAtOnce = 25;

struct Result {
  int kills = 0;
  int players = 0;    ///< of servers that were killed
  int returned = 0;   ///< of them, as the same player
  int disturbed = 0;  ///< players of other servers that lost them meanwhile
  std::vector<long> back;
  std::vector<long> redirects;
  int lost_without_bus = 0;
};

long percentile(std::vector<long> values, std::size_t percent) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, values.size() * percent / 100)];
}

int losses(bench::Bots& bots, std::uint16_t but_of_port) {
  int count = 0;
  for (const auto& bot : bots.all()) count += bot->port() != but_of_port ? bot->losses() : 0;
  return count;
}

void kill(bench::Fleet& fleet, bench::Bots& bots, std::size_t server, Result& result) {
  const std::uint16_t port = fleet.port(server);
  const int before = losses(bots, port);
  std::vector<bench::Bot*> there;
  for (const auto& bot : bots.all()) {
    if (bot->port() == port && bot->isPlaying()) there.push_back(bot.get());
  }
  const auto killed_at = Clock::now();
  fleet.killServer(server);
  for (bench::Bot* p_bot : there) p_bot->noteKill(killed_at);
  bots.serveUntil([] { return false; }, kRestart);
  fleet.startServer(server);
  const auto all_back = [&] {
    return std::all_of(there.begin(), there.end(), [](const auto* p) { return p->isBack(); });
  };
  bots.serveUntil(all_back, kReturnTimeout);
  ++result.kills;
  result.players += static_cast<int>(there.size());
  for (bench::Bot* p_bot : there) {
    if (!p_bot->isBack()) continue;
    result.back.push_back(p_bot->backTime().count());
    result.returned += p_bot->isSamePlayer() ? 1 : 0;
  }
  result.disturbed += losses(bots, port) - before;
}

void loseBus(bench::Fleet& fleet, bench::Bots& bots, std::chrono::seconds time, Result& result) {
  const int before = losses(bots, 0);
  fleet.killBus();
  bots.serveUntil([] { return false; }, time);
  fleet.startBus();
  bots.serveUntil([] { return false; }, 5s);
  result.lost_without_bus = losses(bots, 0) - before;
}

void print(const bench::FleetSetup& setup, const Result& result, std::chrono::seconds bus_time,
           const bench::Fleet::Ticks& ticks) {
  const double late =
      ticks.all > 0 ? 100.0 * static_cast<double>(ticks.late) / static_cast<double>(ticks.all) : 100;
  const bool is_complete = static_cast<int>(result.back.size()) == result.players;
  std::printf(
      "fleet bots=%d servers=%d hz=%d kills=%d players=%d back=%zu returned=%d p50_ms=%ld p99_ms=%ld "
      "max_ms=%ld "
      "redirect_p50_ms=%ld redirect_p99_ms=%ld disturbed=%d bus_seconds=%lld bus_lost=%d ticks=%llu "
      "late_percent=%.2f valid=%d%s\n",
      setup.bots, setup.servers, setup.hz, result.kills, result.players, result.back.size(), result.returned,
      percentile(result.back, 50), percentile(result.back, 99), percentile(result.back, 100),
      percentile(result.redirects, 50), percentile(result.redirects, 99), result.disturbed,
      static_cast<long long>(bus_time.count()), result.lost_without_bus,
      static_cast<unsigned long long>(ticks.all), late, late <= 5 ? 1 : 0, is_complete ? "" : " failed=1");
}

int run(const bench::FleetSetup& setup, int kills, std::chrono::seconds bus_time) {
  bench::Fleet fleet(setup);
  std::fprintf(stderr, "naiad_fleet: %zu servers, logs in %s\n", fleet.size(), fleet.folder().c_str());
  bench::Bots bots(fleet.link(), fleet.folder() / "known_servers", setup.bots);
  Result result;
  if (!bots.joinAll(kJoiningAtOnce, 300s)) {
    std::printf("fleet bots=%d servers=%d joined=%zu failed=1\n", setup.bots, setup.servers, bots.playing());
    return 1;
  }
  for (const auto& bot : bots.all()) result.redirects.push_back(bot->redirectTime().count());
  std::fprintf(stderr, "naiad_fleet: %zu players play\n", bots.playing());
  std::mt19937_64 random(1);
  for (int i = 0; i < kills; ++i) {
    bots.serveUntil([] { return false; }, kPlay);
    kill(fleet, bots, random() % fleet.size(), result);
    std::fprintf(stderr, "naiad_fleet: kill %d of %d, %zu play\n", i + 1, kills, bots.playing());
  }
  if (bus_time.count() > 0) loseBus(fleet, bots, bus_time, result);
  bots.leaveAll();
  fleet.end();
  print(setup, result, bus_time, fleet.ticks());
  return 0;
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
  // A quarter of the places is left, so that players fit wherever servers are killed.
  setup.max_players = setup.bots / setup.servers * 4 / 3 + 4;
  naiad::surviveBrokenPipes();
  naiad::allowOpenFiles(static_cast<std::size_t>(4 * setup.bots + 256));
  try {
    return run(setup, std::atoi(words[1].c_str()), std::chrono::seconds(std::atoi(words[2].c_str())));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "naiad_fleet: %s\n", error.what());
    std::printf("fleet bots=%d failed=1\n", setup.bots);
    return 1;
  }
}
