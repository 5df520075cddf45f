// Tests that, in random worlds whose handlers create, delete, move and resize Objects, the engine's positions
// and events equal those of the oracle bit for bit. Half of the worlds use the options of docs/collisions.md.
//
// NAIAD_ORACLE_WORLDS sets the number of worlds, NAIAD_ORACLE_SEED the seed of the first. Each further world
// has the next seed, so a failing world runs alone with NAIAD_ORACLE_SEED=its seed and NAIAD_ORACLE_WORLDS=1.
// NAIAD_ORACLE_OPTIONS=0 runs these worlds without options: if a failing world then passes, an option is the
// cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "Comparison.h"
#include "Rng.h"

namespace oracle {
namespace {

// Sanitized builds are slower and look for other faults, so they run fewer worlds.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::int64_t kWorlds = 1'000;
#else
constexpr std::int64_t kWorlds = 10'000;
#endif
/// Minimum number of worlds in which every case has to occur.
constexpr std::int64_t kEnough = 200;

std::int64_t setting(const char* name, std::int64_t otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : std::strtoll(value, nullptr, 10);
}

/// Totals of all worlds.
struct Sum : Comparison {
  std::int64_t worlds = 0;
  std::int64_t worlds_with_options = 0;

  void add(const Comparison& one) {
    ++worlds;
    worlds_with_options += one.with_options ? 1 : 0;
    hash = mix(hash ^ one.hash);
    ticks += one.ticks;
    objects += one.objects;
    largest = std::max(largest, one.largest);
    for (const df::NamedPath& path : df::kMoverStats) paths.*path.count += one.paths.*path.count;
    handled += one.handled;
    births += one.births;
    deaths += one.deaths;
    contacts_asked += one.contacts_asked;
    contacts_found += one.contacts_found;
    rooms_asked += one.rooms_asked;
    rooms_found += one.rooms_found;
    counters += one.counters;
  }
};

double percent(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void reportBook(const Sum& sum, double seconds) {
  // Shares of all moveObject() calls: HARD refused by HARD, collided with SOFT, no_soft refused by SOFT, sent
  // an out event, made in a handler of another move.
  const Counters& n = sum.counters;
  const double blocked = percent(n.blocked_hard, n.moves);
  const double soft = percent(n.met_soft, n.moves);
  const double no_soft = percent(n.blocked_soft, n.moves);
  const double out = percent(n.outs, n.moves);
  const double nested = percent(n.nested_moves, n.moves);
  // Shares of all collision and out events handled: Objects created and Objects deleted in the handlers.
  const double birth = percent(sum.births, sum.handled);
  const double death = percent(sum.deaths, sum.handled);
  std::printf("oracle worlds=%" PRId64 " ticks=%" PRId64 " objects=%" PRId64 " largest=%d moves=%" PRId64
              " collisions=%" PRId64 " events=%" PRId64
              " blocked=%.1f%% soft=%.1f%% nosoft=%.1f%% out=%.1f%% nested=%.1f%% birth=%.1f%% death=%.1f%%"
              " too_deep=%" PRId64 " hash=%016" PRIx64 " seconds=%.1f\n",
              sum.worlds, sum.ticks, sum.objects, sum.largest, n.moves, n.collisions, sum.handled, blocked,
              soft, no_soft, out, nested, birth, death, n.too_deep, sum.hash, seconds);

  EXPECT_GE(sum.ticks, sum.worlds * 100);
  if (sum.worlds < kEnough) return;
  for (const double share : {blocked, soft, no_soft, out, nested, birth, death}) EXPECT_GE(share, 1);
  EXPECT_GE(n.too_deep, 1);
}

void reportOptions(const Sum& sum) {
  // Shares: swept and rest moves of all moves; refused, advanced before being refused, and searched again, of
  // swept moves; pairs sharing no cell, of pairs with compared masks; touched another, of rest moves; pairs
  // that did not block because the mover moved out, of all pairs.
  const Counters& n = sum.counters;
  const double swept = percent(n.swept_moves, n.moves);
  const double blocked = percent(n.swept_blocked, n.swept_moves);
  const double stopped = percent(n.swept_stopped, n.swept_moves);
  const double passed = percent(n.swept_passed_on, n.swept_moves);
  const double rejected = percent(n.precise_rejected, n.precise_pairs);
  const double rest = percent(n.rest_moves, n.moves);
  const double rest_met = percent(n.rest_contacts, n.rest_moves);
  const double moved_out = percent(n.moved_out, n.collisions);
  const double contact = percent(sum.contacts_found, sum.contacts_asked);
  const double room = percent(sum.rooms_found, sum.rooms_asked);
  std::printf("oracle worlds with options=%" PRId64
              " swept=%.1f%% blocked=%.1f%% stopped=%.1f%% passed=%.2f%%"
              " precise=%" PRId64
              " rejected=%.1f%% rest=%.1f%% rest_met=%.1f%% moved_out=%.2f%%"
              " contacts=%" PRId64 " found=%.1f%% rooms=%" PRId64 " found=%.1f%%\n",
              sum.worlds_with_options, swept, blocked, stopped, passed, n.precise_pairs, rejected, rest,
              rest_met, moved_out, sum.contacts_asked, contact, sum.rooms_asked, room);

  if (sum.worlds < kEnough) return;
  for (const double share : {swept, blocked, stopped, rejected, rest, rest_met, contact, room})
    EXPECT_GE(share, 1);
  EXPECT_GE(passed, 0.1);
  EXPECT_GE(moved_out, 0.1);
  EXPECT_GE(n.precise_pairs, 1000);
}

/// Prints how often the worlds took each path of the engine and checks that none goes untested. No world is
/// crowded enough for the path `unheard`; CrowdTest covers it.
void reportPaths(const Sum& sum) {
  const df::MoverStats& n = sum.paths;
  const auto turns = static_cast<double>(n.flown + n.walked + n.met + n.deferred + n.special);
  std::printf("oracle paths turns=%.0f", turns);
  for (const df::NamedPath& path : df::kMoverStats) {
    std::printf(" %s=%.2f%%", path.name, 100 * static_cast<double>(n.*path.count) / turns);
    if (sum.worlds >= kEnough && path.count != &df::MoverStats::unheard) {
      EXPECT_GE(n.*path.count, 100) << path.name;
    }
  }
  std::printf("\n");
}

TEST(OracleTest, EngineMatchesTheOracleInRandomWorlds) {
  const std::int64_t worlds = setting("NAIAD_ORACLE_WORLDS", kWorlds);
  const std::int64_t first_seed = setting("NAIAD_ORACLE_SEED", 1);
  const bool with_options = setting("NAIAD_ORACLE_OPTIONS", 1) != 0;
  const auto begin = std::chrono::steady_clock::now();

  Sum sum;
  for (std::int64_t i = 0; i < worlds; ++i) {
    const Comparison one = compareWorld(static_cast<std::uint64_t>(first_seed + i), with_options);
    ASSERT_TRUE(one.difference.empty())
        << "engine and oracle differ after " << i + 1 << " worlds: " << one.difference;
    sum.add(one);
  }

  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  reportBook(sum, seconds.count());
  if (with_options) reportOptions(sum);
  reportPaths(sum);
}

}  // namespace
}  // namespace oracle
