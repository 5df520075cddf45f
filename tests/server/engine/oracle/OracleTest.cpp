// The property: in random worlds whose handlers create, delete, move and resize, the engine's positions and
// events equal those of the book's loop, bit for bit.
//
// NAIAD_ORACLE_WORLDS sets the number of worlds, NAIAD_ORACLE_SEED the seed of the first; each next world has
// the next seed, so a failing one runs alone with NAIAD_ORACLE_SEED=its seed and NAIAD_ORACLE_WORLDS=1.
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

// A sanitizer makes the same worlds slower and looks for other things; it gets fewer of them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::int64_t kWorlds = 1'000;
#else
constexpr std::int64_t kWorlds = 10'000;
#endif

std::int64_t setting(const char* name, std::int64_t otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : std::strtoll(value, nullptr, 10);
}

void add(Comparison& sum, const Comparison& one) {
  sum.hash = mix(sum.hash ^ one.hash);
  sum.ticks += one.ticks;
  sum.objects += one.objects;
  sum.largest = std::max(sum.largest, one.largest);
  sum.handled += one.handled;
  sum.births += one.births;
  sum.deaths += one.deaths;
  sum.counters.moves += one.counters.moves;
  sum.counters.nested_moves += one.counters.nested_moves;
  sum.counters.too_deep += one.counters.too_deep;
  sum.counters.blocked_hard += one.counters.blocked_hard;
  sum.counters.blocked_soft += one.counters.blocked_soft;
  sum.counters.outs += one.counters.outs;
  sum.counters.collisions += one.counters.collisions;
  sum.counters.met_soft += one.counters.met_soft;
}

double percent(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

TEST(OracleTest, EngineEqualsTheBooksLoopInRandomWorlds) {
  const std::int64_t worlds = setting("NAIAD_ORACLE_WORLDS", kWorlds);
  const std::int64_t first_seed = setting("NAIAD_ORACLE_SEED", 1);
  const auto begin = std::chrono::steady_clock::now();

  Comparison sum;
  for (std::int64_t i = 0; i < worlds; ++i) {
    const Comparison one = compareWorld(static_cast<std::uint64_t>(first_seed + i));
    ASSERT_TRUE(one.difference.empty())
        << "engine and oracle differ after " << i + 1 << " worlds: " << one.difference;
    add(sum, one);
  }

  // Of all calls of moveObject, by update and by handlers: refused because HARD met HARD, met with SOFT as
  // mover or as other, refused because no soft met SOFT, sent an out event, made by a handler within another.
  const Counters& n = sum.counters;
  const double blocked = percent(n.blocked_hard, n.moves);
  const double soft = percent(n.met_soft, n.moves);
  const double no_soft = percent(n.blocked_soft, n.moves);
  const double out = percent(n.outs, n.moves);
  const double nested = percent(n.nested_moves, n.moves);
  // Of all collision and out events that handlers got: Objects made, and Objects condemned, within them.
  const double birth = percent(sum.births, sum.handled);
  const double death = percent(sum.deaths, sum.handled);

  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("oracle worlds=%" PRId64 " ticks=%" PRId64 " objects=%" PRId64 " largest=%d moves=%" PRId64
              " collisions=%" PRId64 " events=%" PRId64
              " blocked=%.1f%% soft=%.1f%% nosoft=%.1f%% out=%.1f%% nested=%.1f%% birth=%.1f%% death=%.1f%%"
              " too_deep=%" PRId64 " hash=%016" PRIx64 " seconds=%.1f\n",
              worlds, sum.ticks, sum.objects, sum.largest, n.moves, n.collisions, sum.handled, blocked, soft,
              no_soft, out, nested, birth, death, n.too_deep, sum.hash, seconds.count());

  EXPECT_GE(sum.ticks, worlds * 100);
  EXPECT_GE(blocked, 1);
  EXPECT_GE(soft, 1);
  EXPECT_GE(no_soft, 1);
  EXPECT_GE(out, 1);
  EXPECT_GE(nested, 1);
  EXPECT_GE(birth, 1);
  EXPECT_GE(death, 1);
  EXPECT_GE(n.too_deep, 1);
}

}  // namespace
}  // namespace oracle
