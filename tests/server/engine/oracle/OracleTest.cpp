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
#include <initializer_list>

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
    largest = std::max(largest, one.largest);
    for (const df::NamedPath& path : df::kMoverStats) paths.*path.count += one.paths.*path.count;
    for (const auto member :
         {&Comparison::ticks, &Comparison::objects, &Comparison::handled, &Comparison::births,
          &Comparison::deaths, &Comparison::contacts_asked, &Comparison::contacts_found,
          &Comparison::rooms_asked, &Comparison::rooms_found}) {
      this->*member += one.*member;
    }
    counters += one.counters;
  }
};

/// The frequency of an event. In enough worlds, it must be `least` percent.
struct Share {
  const char* name;
  std::int64_t part;
  std::int64_t whole;
  double least = 1;
};

void reportShares(const Sum& sum, std::initializer_list<Share> shares) {
  for (const Share& share : shares) {
    const double percent =
        share.whole == 0 ? 0 : 100.0 * static_cast<double>(share.part) / static_cast<double>(share.whole);
    std::printf(" %s=%.2f%%", share.name, percent);
    if (sum.worlds >= kEnough) {
      EXPECT_GE(percent, share.least) << share.name;
    }
  }
}

void reportBook(const Sum& sum, double seconds) {
  const Counters& n = sum.counters;
  std::printf("oracle worlds=%" PRId64 " ticks=%" PRId64 " objects=%" PRId64 " largest=%d moves=%" PRId64
              " collisions=%" PRId64 " events=%" PRId64 " too_deep=%" PRId64,
              sum.worlds, sum.ticks, sum.objects, sum.largest, n.moves, n.collisions, sum.handled,
              n.too_deep);
  reportShares(sum, {{"blocked", n.blocked_hard, n.moves},
                     {"soft", n.met_soft, n.moves},
                     {"nosoft", n.blocked_soft, n.moves},
                     {"out", n.outs, n.moves},
                     {"nested", n.nested_moves, n.moves},
                     {"birth", sum.births, sum.handled},
                     {"death", sum.deaths, sum.handled}});
  std::printf(" hash=%016" PRIx64 " seconds=%.1f\n", sum.hash, seconds);
  EXPECT_GE(sum.ticks, sum.worlds * 100);
  EXPECT_TRUE(sum.worlds < kEnough || n.too_deep >= 1);
}

void reportOptions(const Sum& sum) {
  const Counters& n = sum.counters;
  std::printf("oracle worlds with options=%" PRId64 " precise=%" PRId64 " contacts=%" PRId64
              " rooms=%" PRId64,
              sum.worlds_with_options, n.precise_pairs, sum.contacts_asked, sum.rooms_asked);
  reportShares(sum, {{"swept", n.swept_moves, n.moves},
                     {"blocked", n.swept_blocked, n.swept_moves},
                     {"stopped", n.swept_stopped, n.swept_moves},
                     {"passed", n.swept_passed_on, n.swept_moves, 0.1},
                     {"rejected", n.precise_rejected, n.precise_pairs},
                     {"rest", n.rest_moves, n.moves},
                     {"rest_met", n.rest_contacts, n.rest_moves},
                     {"moved_out", n.moved_out, n.collisions, 0.1},
                     {"contacts_found", sum.contacts_found, sum.contacts_asked},
                     {"rooms_found", sum.rooms_found, sum.rooms_asked}});
  std::printf("\n");
  EXPECT_TRUE(sum.worlds < kEnough || n.precise_pairs >= 1000);
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
