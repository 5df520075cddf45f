// capacity: the number of players in the 1000-object world that one core serves, and the cost of a bare
// sender of equal datagrams. docs/bench.md describes it.
#include <sched.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "Worker.h"
#include "tests/support/TempFolder.h"

namespace bench {
namespace {

using namespace std::chrono_literals;

constexpr int kStep = 250;
constexpr double kTick = 1.0 / 30;
/// If the bots use more than this share of their core, they are the limit, not the server.
constexpr double kBotsBusy = 0.95;

/// Share of wrong screens allowed for moments in which this machine was busy with other work.
constexpr double kMaxWrong = 0.02;

struct Effort {
  double settle_s = 5;
  double measure_s = 30;
  int first = 1000;
  int most = 8000;
  int trials = 12;
};

/// The results of a trial with one number of players.
struct Trial {
  int clients = 0;
  double busy = 0;       ///< share of its core used by the server
  double cpu_us = 0;     ///< the server's processor time per client and tick, in microseconds
  double datagrams = 0;  ///< datagrams per tick to all clients
  double bytes = 0;      ///< bytes per datagram
  double delivered = 0;
  double tick_p50_ms = 0, tick_p99_ms = 0;
  double ticks = 0, late = 0;
  double bots_busy = 0;
  double checked = 0, wrong = 0;
  std::string limit;  ///< exceeded limit; empty: none
};

using Pictures = std::map<std::pair<std::string, std::string>, std::string>;

/// Reads the worker's lines up to `done`. Returns the checksum of each picture, by tick and player.
Pictures picturesOf(Worker& worker) {
  Pictures pictures;
  for (std::string line = worker.hear(); line != "done"; line = worker.hear()) {
    std::istringstream words(line);
    std::string word, tick, player, sum;
    words >> word >> tick >> player >> sum;
    pictures[{tick, player}] = sum;
  }
  return pictures;
}

class Arena {
 public:
  Arena(int server_core, int bot_core, int most) : m_server_core(server_core), m_bot_core(bot_core) {
    const std::string bin = std::string(NAIAD_BINARY_DIR) + "/bin/";
    m_server = std::make_unique<Worker>(
        std::vector<std::string>{bin + "naiad_capacity_server", std::to_string(server_core),
                                 m_folder / "identity", std::to_string(most)});
    std::istringstream words(m_server->hear());
    std::string word, address, flag, fingerprint;
    words >> word >> address >> flag >> fingerprint;
    const std::size_t colon = address.rfind(':');
    m_bots = std::make_unique<Worker>(std::vector<std::string>{
        bin + "naiad_capacity_bots", std::to_string(bot_core), address.substr(0, colon),
        address.substr(colon + 1), fingerprint, m_folder.string()});
  }
  Trial run(int clients, const Effort& effort) {
    progress("capacity: " + std::to_string(clients) + " clients");
    m_bots->ask("go " + std::to_string(clients), "ready", 300s);
    std::this_thread::sleep_for(std::chrono::duration<double>(effort.settle_s));
    m_server->tell("begin");
    m_bots->ask("begin", "begun");
    const double cpu = m_server->cpu();
    const auto began = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(std::chrono::duration<double>(effort.measure_s));
    const double used = m_server->cpu() - cpu;
    const double wall =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - began).count();
    auto bots = figuresOf(m_bots->ask("end", "figures"));
    const Pictures seen = picturesOf(*m_bots);
    auto server = figuresOf(m_server->ask("end", "figures"));
    const Pictures truth = picturesOf(*m_server);

    Trial trial;
    trial.clients = clients;
    trial.busy = used / wall;
    trial.ticks = server["ticks"];
    trial.late = server["late_ticks"];
    trial.cpu_us = used / (wall * 1e-6 / kTick) / clients;
    trial.datagrams = bots["received"] / (wall * 1e-6 / kTick) * clients / bots["bots"];
    trial.bytes = bots["received"] > 0 ? bots["bytes"] / bots["received"] : 0;
    trial.delivered = bots["received"] / std::max(1.0, bots["received"] + bots["missing"]);
    if (bots["silent"] > 0) trial.delivered -= bots["silent"] / bots["bots"];
    trial.tick_p50_ms = server["tick_p50_us"] / 1000;
    trial.tick_p99_ms = server["tick_p99_us"] / 1000;
    trial.bots_busy = bots["busy"];
    for (const auto& [key, sum] : seen) {
      const auto found = truth.find(key);
      if (found == truth.end()) continue;  // the server did not record this tick
      ++trial.checked;
      trial.wrong += found->second != sum ? 1 : 0;
    }
    trial.limit = limitOf(trial);
    return trial;
  }

  /// Returns a bare sender's processor time per client and tick.
  double bare(const Trial& trial, double seconds) {
    m_bots->ask("sink", "sunk");
    m_server.reset();
    const auto finished =
        runProgram({std::string(NAIAD_BINARY_DIR) + "/bin/naiad_capacity_bare", std::to_string(m_server_core),
                    m_folder.string(), std::to_string(std::lround(trial.datagrams)),
                    std::to_string(std::lround(seconds / kTick))});
    auto figures = figuresOf(finished.output);
    if (finished.code != 0 || figures["datagrams"] == 0) throw std::runtime_error("the bare sender failed");
    return figures["cpu_us"] / (seconds / kTick) / trial.clients;
  }

 private:
  static std::string limitOf(const Trial& trial) {
    std::string limit;
    if (trial.wrong > kMaxWrong * trial.checked) limit = "screens";
    if (trial.delivered < 0.999) limit = "delivery";
    if (trial.late > std::max(1.0, trial.ticks / 1000)) limit = "late_ticks";
    if (trial.tick_p99_ms >= 33) limit = "tick_p99";
    if (trial.busy > 0.995) limit = "cpu";
    if (!limit.empty() && trial.busy < 0.9 && trial.bots_busy > kBotsBusy) limit = "bots";
    return limit;
  }

  int m_server_core;
  int m_bot_core;
  naiad::test::TempFolder m_folder;
  std::unique_ptr<Worker> m_server;
  std::unique_ptr<Worker> m_bots;
};

void print(const Trial& trial, const char* kind) {
  Line line("capacity");
  line.add("trial", std::string(kind))
      .add("clients", trial.clients)
      .add("busy_percent", 100 * trial.busy)
      .add("bots_busy_percent", 100 * trial.bots_busy)
      .add("cpu_us_per_client", trial.cpu_us)
      .add("datagrams_per_client_tick", trial.datagrams / trial.clients)
      .add("bytes_per_datagram", trial.bytes)
      .add("delivered_percent", 100 * trial.delivered)
      .add("tick_p50_ms", trial.tick_p50_ms)
      .add("tick_p99_ms", trial.tick_p99_ms)
      .add("late_ticks", trial.late)
      .add("screens_checked", trial.checked)
      .add("wrong_screens", trial.wrong);
  if (!trial.limit.empty()) line.add("exceeded", trial.limit);
}

int stepped(double clients) {
  return std::max(kStep, static_cast<int>(clients) / kStep * kStep);
}

/// Searches for the largest number of players that passes. The next number to try is a guess from the
/// measured cost of a client.
void search(const std::function<std::unique_ptr<Arena>()>& open, const Effort& effort, bool quick) {
  std::unique_ptr<Arena> arena = open();
  std::map<int, Trial> trials;
  const auto attempt = [&](int clients) -> const Trial& {
    const auto found = trials.find(clients);
    if (found != trials.end()) return found->second;
    const Trial& trial = trials[clients] = arena->run(clients, effort);
    print(trial, trial.limit.empty() ? "passed" : "failed");
    // After an overload, a server sends to the affected clients less often for a while, so the next trial
    // uses a new server.
    if (!trial.limit.empty()) {
      arena.reset();
      arena = open();
    }
    return trial;
  };
  int best = 0;
  int clients = effort.first;
  for (int i = 0; i < effort.trials && clients > best && clients <= effort.most; ++i) {
    const Trial& trial = attempt(clients);
    if (!trial.limit.empty()) break;
    best = clients;
    const int guess = stepped(0.93 * clients / trial.busy);
    clients = std::max(clients + kStep, std::min(guess, clients + 2000));
  }
  // Tries up to seven steps below the lowest failed number, from above; with --quick, one in the middle.
  int above = trials.empty() ? 0 : trials.rbegin()->first;
  if (above > best && !quick) {
    for (int n = above - kStep; n > best && n > above - 8 * kStep; n -= kStep) {
      if (attempt(n).limit.empty()) best = n;
    }
  } else if (above > best && above - best > kStep) {
    const int middle = stepped((above + best) / 2.0);
    if (attempt(middle).limit.empty()) best = std::max(best, middle);
  }
  std::string limit = above > best ? trials[above].limit : "most";
  for (const auto& [n, trial] : trials) {
    if (n > best) {
      limit = trial.limit;
      break;
    }
  }
  const Trial& result = best > 0 ? trials[best] : trials.begin()->second;
  arena->run(result.clients, {.settle_s = 2, .measure_s = 2});  // makes the sockets that the bare sender uses
  const double bare = arena->bare(result, quick ? 5 : 20);
  Line line("capacity");
  line.add("clients_per_core", best)
      .add("tick_p99_ms", result.tick_p99_ms)
      .add("late_ticks", result.late)
      .add("cpu_us_per_client", result.cpu_us)
      .add("bare_us_per_client", bare)
      .add("bare_send_ratio", result.cpu_us / bare)
      .add("limited_by", limit)
      .add("seconds", effort.measure_s)
      .add("screens_checked", result.checked)
      .add("wrong_screens", result.wrong);
}

void skip(const std::string& reason) {
  Line("capacity").add("skipped", reason);
}

const Suite s_suite("capacity", "players that one core serves, and what a bare sender needs",
                    [](const Options& options) {
                      cpu_set_t allowed;
                      CPU_ZERO(&allowed);
                      sched_getaffinity(0, sizeof allowed, &allowed);
                      std::vector<int> cores;
                      for (int i = 0; i < CPU_SETSIZE; ++i) {
                        if (CPU_ISSET(i, &allowed)) cores.push_back(i);
                      }
                      if (cores.size() < 2) return skip("needs-two-cores");
                      rlimit files{};
                      getrlimit(RLIMIT_NOFILE, &files);
                      if (files.rlim_max < 8192) return skip("needs-8192-open-files");
                      Effort effort;
                      effort.most = std::min<int>(effort.most, static_cast<int>((files.rlim_max - 1024) / 2));
                      if (options.quick) effort = {2, 5, 1000, effort.most, 4};
                      if (const char* clients = getenv("NAIAD_CAPACITY_CLIENTS")) {
                        effort.first = effort.most = std::stoi(clients);
                        effort.trials = 1;
                      }
                      search([&] { return std::make_unique<Arena>(cores[0], cores[1], effort.most); }, effort,
                             options.quick);
                    });

}  // namespace
}  // namespace bench
