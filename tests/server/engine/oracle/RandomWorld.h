// A random world, drawn from a seed: its size, density and first Objects. A seed gives an equal world on
// every machine. Script.h defines what the handlers do.
#pragma once

#include <cstdint>
#include <vector>

#include "Options.h"
#include "Rng.h"
#include "shared/values/Fixed.h"

namespace oracle {

inline constexpr df::Fixed kOne = df::kFixedOne;

/// The behaviour of an Object's handler.
enum class Temper {
  QUIET,     ///< Rarely does anything.
  LIVELY,    ///< Makes a random change at about every second collision.
  BULLET,    ///< Usually deletes itself at a collision, and may delete the other Object, if that is HARD.
  PARENT,    ///< Creates other Objects at collisions.
  STUBBORN,  ///< Usually repeats the refused move in its collision handler.
  GLASS,     ///< Usually deletes, removes or disables itself when it is hit.
  DEAF,      ///< Has no handler.
};

/// All initial properties of an Object.
struct Spec : State {
  FixedVector acceleration;
  Mask mask;
  Temper temper = Temper::QUIET;
};

/// The kind of a world.
enum class Kind {
  USUAL,
  HARD_CHARACTERS,    ///< Only HARD single characters.
  CHARACTERS,         ///< Only single characters.
  NEARLY_CHARACTERS,  ///< One Object in a hundred has another box.
  UNLIMITED,          ///< Speeds up to a million cells per tick.
  HUGE_BOXES,         ///< Boxes up to 10,000 cells wide.
  FAR,                ///< Near one or both ends of the number range.
  SCATTERED,          ///< Spread over a million by a million cells, and five small towns.
  CROWDED,            ///< All Objects at one point.
  LARGE,              ///< A thousand Objects.
};

struct RandomWorld {
  std::uint64_t seed = 0;
  Kind kind = Kind::USUAL;
  OptionMix options;
  int ticks = 100;
  FixedBox boundary;
  std::vector<FixedBox> areas;  ///< Objects are put in these areas, which may extend beyond the boundary
  Fixed grain = 1;              ///< grid of positions and sizes; a coarse one makes edges touch
  Fixed speed_limit = 1;        ///< maximum speed, per axis and tick
  int moving_percent = 70;
  int solid_mix = 0;  ///< selects the most frequent Solidness
  int no_soft_percent = 10;
  int large_percent = 10;
  int accelerated_percent = 10;
  int deaf_percent = 0;
  int population_limit = 300;
  int moves_per_tick = 40;  ///< maximum of moveObject() calls by handlers
  std::vector<Spec> objects;

  /// If `with_options` is false, the world differs only by having no options.
  explicit RandomWorld(std::uint64_t world_seed, bool with_options = true);

  /// Draw parts of a Spec, also for Objects that scripts create or change later.
  Spec randomSpec(Rng& rng) const;
  FixedVector randomPosition(Rng& rng) const;
  FixedVector randomVelocity(Rng& rng) const;
  FixedVector randomAcceleration(Rng& rng) const;
  FixedBox randomBox(Rng& rng) const;
  Solidness randomSolidness(Rng& rng) const;
  /// True if the position is more than 20 cells away from all areas.
  bool isLost(FixedVector position) const;

 private:
  void layOut(Rng& rng, int population);
  void specialise(Rng& rng);
  Fixed onGrain(std::int64_t value) const { return value - value % grain; }
};

}  // namespace oracle
