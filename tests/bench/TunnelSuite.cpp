// Tests that nothing passes through anything: a million shots at all kinds of targets, in random directions,
// at speeds from a tenth of a cell to a million cells per second, and some at up to a million cells per tick.
// Range.h defines what counts as a hit and as passing through.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "RandomMask.h"
#include "Range.h"
#include "ResultLine.h"
#include "Suite.h"
#include "shared/values/SplitMix64.h"

namespace bench {
namespace {

using naiad::SplitMix64;

enum class Shape {
  UNIT,    ///< 1×1
  SPRITE,  ///< 3×2 to 12×4, all cells set
  GLYPHS,  ///< 3×2 to 12×4 characters with holes, precise
  THIN,    ///< 0.01×8 or 8×0.01
  NEEDLE,  ///< 0.01×0.01
  WALL,    ///< 10,000×1 or 1×10,000
};

enum class Motion {
  REST,     ///< the older one rests, the younger one flies towards it
  FIRES,    ///< the older one flies, the younger one rests
  BOTH,     ///< both fly in any direction
  HEAD_ON,  ///< both fly along an axis towards each other, almost straight
};

/// The kinds of two Objects and how they move. The older Object moves first.
struct Pairing {
  const char* name;
  Shape older;
  Shape younger;
  Motion motion = Motion::REST;
  Make make_older{};
  Make make_younger{};
  int ticks = 1;     ///< ticks of a shot, which determine its initial distance
  double speed = 0;  ///< cells per tick; 0: random
};

constexpr double kTicksPerSecond = 30;
constexpr double kFastPart = 0.1;  // share of shots faster than a million cells per second
constexpr double kFieldSide = 1000;

df::Fixed fixed(double cells) {
  return std::llrint(cells * static_cast<double>(df::kFixedOne));
}

double between(double least, double most, SplitMix64& random) {
  return least + (most - least) * random.unit();
}

double logarithmicallyBetween(double least, double most, SplitMix64& random) {
  return std::exp(between(std::log(least), std::log(most), random));
}

df::FixedBox boxOf(double width, double height) {
  return {{-fixed(width) / 2, -fixed(height) / 2}, {fixed(width), fixed(height)}};
}

Flier shape(Shape shape, SplitMix64& random) {
  Flier flier;
  double width = 1;
  double height = 1;
  if (shape == Shape::SPRITE || shape == Shape::GLYPHS) {
    const oracle::Mask mask = randomMask(random);
    width = static_cast<double>(mask[0].size());
    height = static_cast<double>(mask.size());
    if (shape == Shape::GLYPHS) flier.mask = mask;
  }
  if (shape == Shape::THIN || shape == Shape::NEEDLE) width = 0.01;
  if (shape == Shape::NEEDLE) height = 0.01;
  if (shape == Shape::THIN) height = 8;
  if (shape == Shape::WALL) width = 10'000;
  if (shape != Shape::GLYPHS && random.below(2) == 0) std::swap(width, height);
  flier.box = boxOf(width, height);
  return flier;
}

// Draws the speed of a shot, in cells per tick. The highest speeds are drawn only for shots of one tick,
// because positions are read as doubles.
double drawSpeed(const Pairing& pairing, SplitMix64& random) {
  if (pairing.speed > 0) return pairing.speed;
  const double usual = 1e6 / kTicksPerSecond;
  if (pairing.ticks == 1 && random.unit() < kFastPart) return logarithmicallyBetween(usual, 1e6, random);
  return logarithmicallyBetween(0.1 / kTicksPerSecond, usual, random);
}

df::FixedVector drawVelocity(const Pairing& pairing, SplitMix64& random) {
  const double speed = drawSpeed(pairing, random);
  const double angle = 2 * std::numbers::pi * random.unit();
  return {fixed(speed * std::cos(angle)), fixed(speed * std::sin(angle))};
}

void chooseVelocities(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  if (pairing.motion != Motion::REST) older.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::FIRES) younger.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::HEAD_ON) return;
  const df::Fixed ahead = fixed(drawSpeed(pairing, random));
  const df::Fixed against = fixed(drawSpeed(pairing, random));
  const df::Fixed aside = fixed(between(-0.3, 0.3, random));
  older.velocity = {ahead, aside};
  younger.velocity = {-against, fixed(between(-0.3, 0.3, random))};
  if (random.below(2) == 0) return;
  for (Flier* p_flier : {&older, &younger}) std::swap(p_flier->velocity.x, p_flier->velocity.y);
}

// Draws a position of the younger Object relative to the older one at which the two touch, mostly just
// barely.
df::FixedVector drawContact(const Flier& older, const Flier& younger, SplitMix64& random) {
  const double reach_x = df::toCells(older.box.size.x + younger.box.size.x) / 2;
  const double reach_y = df::toCells(older.box.size.y + younger.box.size.y) / 2;
  double x = between(-1, 1, random);
  double y = between(-1, 1, random);
  (random.below(2) == 0 ? x : y) = random.below(2) == 0 ? 1 : -1;
  const double depth = random.unit() < 0.6 ? 1 : between(0, 1.1, random);
  return {fixed(depth * x * reach_x), fixed(depth * y * reach_y)};
}

df::FixedVector times(df::FixedVector v, double factor) {
  return {fixed(df::toCells(v.x) * factor), fixed(df::toCells(v.y) * factor)};
}

/// Draws a shot: places the two so that they touch at a moment of the first turn, of the second, or of a
/// flight in which both move at once, and do not touch at the start.
void aim(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  do {
    older = shape(pairing.older, random);
    younger = shape(pairing.younger, random);
    chooseVelocities(pairing, older, younger, random);
    const double x = between(-kFieldSide, kFieldSide, random);
    const double y = between(-kFieldSide, kFieldSide, random);
    older.position = {fixed(x), fixed(y)};
    const double time = random.unit() * std::max(1, pairing.ticks - 2);
    double older_gone = time;
    double younger_gone = time;
    if (pairing.motion == Motion::BOTH || pairing.motion == Motion::HEAD_ON) {
      const std::uint64_t moment = random.below(3);
      if (moment == 0) younger_gone = 0;
      if (moment == 1) older_gone = 1;
    }
    younger.position = older.position + times(older.velocity, older_gone) -
                       times(younger.velocity, younger_gone) + drawContact(older, younger, random);
  } while (areMet(older, younger));
}

Account fire(const Pairing& pairing, long shots, bool all_swept) {
  Range range(pairing.make_older, pairing.make_younger);
  if (all_swept) range.sweepAll();
  if (pairing.speed > 0) range.judgeUnswept();
  SplitMix64 random(20240607);
  Account account;
  Flier older;
  Flier younger;
  while (account.shots < shots) {
    aim(pairing, older, younger, random);
    range.set(older, younger);
    for (int tick = 0; tick < pairing.ticks; ++tick) range.tick(account);
  }
  return account;
}

void measure(const Pairing& pairing, long shots) {
  const bool swept = pairing.speed == 0;
  const bool all_swept = std::string(pairing.name) == "all_swept";
  const Account account = fire(pairing, shots, all_swept);
  const auto percentOf = [](long part, long whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(whole);
  };
  Line line("tunnel");
  line.add("pair", pairing.name).add("shots", static_cast<long long>(account.shots));
  if (swept) {
    line.addZero("through", account.through).addZero("ghosts", account.ghosts);
  } else {
    line.add("through", static_cast<long long>(account.through));
    line.add("through_percent", percentOf(account.through, account.hits)).add("speed", pairing.speed);
  }
  line.add("hits_percent", percentOf(account.hits, account.shots));
  if (pairing.motion == Motion::BOTH || pairing.motion == Motion::HEAD_ON) {
    line.add("simultaneous_only_percent", percentOf(account.simultaneous, account.shots));
  }
}

const Make kSoft{df::SOFT};
const Make kNoSoft{df::HARD, true};
const Make kUnswept{df::HARD, false, false};

const Pairing kPairings[] = {
    {"static", Shape::UNIT, Shape::UNIT},
    {"static_younger", Shape::UNIT, Shape::UNIT, Motion::FIRES},
    {"all_swept", Shape::UNIT, Shape::UNIT, Motion::BOTH, kUnswept, kUnswept},
    {"moving", Shape::UNIT, Shape::UNIT, Motion::BOTH, kUnswept},
    {"moving_younger", Shape::UNIT, Shape::UNIT, Motion::BOTH, {}, kUnswept},
    {"fast_fast", Shape::UNIT, Shape::UNIT, Motion::BOTH},
    {"head_on", Shape::UNIT, Shape::UNIT, Motion::HEAD_ON},
    {"soft", Shape::UNIT, Shape::UNIT, Motion::REST, kSoft},
    {"no_soft", Shape::UNIT, Shape::UNIT, Motion::REST, kSoft, kNoSoft},
    {"thin", Shape::THIN, Shape::UNIT},
    {"needle_thin", Shape::THIN, Shape::NEEDLE},
    {"needle_needle", Shape::NEEDLE, Shape::NEEDLE, Motion::BOTH},
    {"sprite", Shape::SPRITE, Shape::SPRITE},
    {"sprite_fast", Shape::SPRITE, Shape::SPRITE, Motion::BOTH},
    {"precise", Shape::GLYPHS, Shape::GLYPHS},
    {"precise_fast", Shape::GLYPHS, Shape::GLYPHS, Motion::BOTH},
    {"wall", Shape::WALL, Shape::UNIT},
    {"wall_needle", Shape::WALL, Shape::NEEDLE},
    {"wall_moves", Shape::WALL, Shape::UNIT, Motion::FIRES},
    {"wall_fast", Shape::WALL, Shape::WALL, Motion::BOTH},
    {"flight", Shape::UNIT, Shape::UNIT, Motion::REST, {}, {}, 8},
    {"flight_precise", Shape::GLYPHS, Shape::GLYPHS, Motion::REST, {}, {}, 8},
};

const Suite s_suite("tunnel", "does anything swept pass through anything? a million shots",
                    [](const Options& options) {
                      progress("tunnel");
                      const long shots = options.quick ? 3000 : 46'000;
                      for (const Pairing& pairing : kPairings) measure(pairing, shots);
                      for (const double speed : {0.5, 2.0, 8.0, 32.0, 128.0}) {
                        Pairing unswept{"static_unswept", Shape::UNIT, Shape::UNIT,
                                        Motion::REST,     {},          kUnswept};
                        unswept.speed = speed;
                        measure(unswept, shots);
                      }
                    });

}  // namespace
}  // namespace bench
