// Does anything pass through anything? A million shots at all kinds of targets, in random directions, at
// speeds from a tenth of a cell per second to a million, and some of a million per tick. Range.h says what
// counts.
#include <string>

#include "Range.h"
#include "ResultLine.h"
#include "Shots.h"
#include "Suite.h"
#include "shared/values/SplitMix64.h"

namespace bench {

namespace {

Account fire(const Pairing& pairing, long shots, bool all_swept) {
  Range range(pairing.make_older, pairing.make_younger);
  if (all_swept) range.sweepAll();
  if (pairing.speed > 0) range.judgeUnswept();
  naiad::SplitMix64 random(20240607);
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
