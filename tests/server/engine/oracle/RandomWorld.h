// A world to try, drawn from a seed: how large, how crowded, and what Objects there are at first. The same
// seed gives the same world on every machine. What its handlers do is in Script.h.
#pragma once

#include <cstdint>
#include <vector>

#include "Options.h"
#include "Rng.h"
#include "shared/values/Fixed.h"
#include "shared/values/Solidness.h"

namespace oracle {

using df::FixedVector;
using df::Solidness;

inline constexpr df::Fixed kOne = df::kFixedOne;

/// How an Object's handler behaves.
enum class Temper {
  QUIET,     ///< Hardly ever does anything.
  LIVELY,    ///< Does something, anything, at every second event.
  BULLET,    ///< Dies at a collision, often by its own hand.
  PARENT,    ///< Makes others.
  STUBBORN,  ///< Tries the refused move again from its handler, and again.
  GLASS,     ///< Mostly deletes itself when it is hit.
  DEAF,      ///< Has no handler.
};

/// Everything about an Object when it is made.
struct Spec {
  FixedVector position;
  FixedVector velocity;
  FixedVector acceleration;
  FixedBox box;
  Solidness solidness = df::HARD;
  bool no_soft = false;
  bool active = true;
  Options options;
  Mask mask;
  Temper temper = Temper::QUIET;
};

/// What is special about a world.
enum class Kind {
  USUAL,
  HARD_CHARACTERS,    ///< Nothing but HARD single characters.
  CHARACTERS,         ///< Nothing but single characters.
  NEARLY_CHARACTERS,  ///< One in a hundred has another box.
  UNLIMITED,          ///< Up to a million cells per tick.
  HUGE_BOXES,         ///< Up to 10,000 cells.
  FAR,                ///< Near the ends of the number range, one or both.
  SCATTERED,          ///< Over a million by a million cells, and in a few towns.
  CROWDED,            ///< All at one point.
  LARGE,              ///< A thousand Objects.
};

struct RandomWorld {
  std::uint64_t seed = 0;
  Kind kind = Kind::USUAL;
  OptionMix options;
  int ticks = 100;
  FixedBox boundary;
  std::vector<FixedBox> areas;  ///< where Objects are put; may reach over the boundary
  Fixed grain = 1;              ///< positions and sizes are multiples of this: coarse ones make edges touch
  Fixed speed_limit = 1;        ///< of the fast ones; per axis and tick
  int moving_percent = 70;
  int solid_mix = 0;  ///< which Solidness is frequent
  int no_soft_percent = 10;
  int large_percent = 10;
  int accelerated_percent = 10;
  int deaf_percent = 0;
  int population_limit = 300;
  int moves_per_tick = 40;  ///< moveObject by handlers; more are not tried
  std::vector<Spec> objects;

  /// Without `with_options`, the world is the same, but for the options.
  explicit RandomWorld(std::uint64_t world_seed, bool with_options = true);

  /// Parts of a Spec, for those that scripts change or make later.
  Spec randomSpec(Rng& rng) const;
  FixedVector randomPosition(Rng& rng) const;
  FixedVector randomVelocity(Rng& rng) const;
  FixedVector randomAcceleration(Rng& rng) const;
  FixedBox randomBox(Rng& rng) const;
  Solidness randomSolidness(Rng& rng) const;
  /// Is this more than 20 cells away from all areas?
  bool isLost(FixedVector position) const;

 private:
  void layOut(Rng& rng, int population);
  void specialise(Rng& rng);
  Fixed onGrain(std::int64_t value) const { return value - value % grain; }
};

}  // namespace oracle
