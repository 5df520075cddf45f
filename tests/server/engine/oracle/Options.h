// The options of an Object beyond the book (docs/collisions.md), its state, and the frequency of each option
// in a world.
#pragma once

#include "OracleMask.h"
#include "Rng.h"
#include "shared/values/Solidness.h"

namespace oracle {

using df::FixedVector;
using df::Solidness;

/// The options of one Object.
struct Options {
  bool swept = false;
  bool precise = false;
  bool rest_contacts = false;
  bool may_move_out = false;

  friend bool operator==(const Options&, const Options&) = default;
};

/// The state of an Object, which is compared after each tick.
struct State {
  FixedVector position;
  FixedVector velocity;
  FixedBox box;  ///< relative to the position
  Solidness solidness = df::HARD;
  bool no_soft = false;
  bool active = true;
  Options options;

  friend bool operator==(const State&, const State&) = default;
};

/// Percentages of a world's Objects with each option, and the options that scripts may change.
struct OptionMix {
  bool any = false;  ///< false: no options at all
  int swept = 0;
  int precise = 0;
  int masked = 0;
  int rest_contacts = 0;
  int may_move_out = 0;
  bool sweep_all = false;      ///< the world's setSweptCollisions() at the start
  bool scripts_sweep = false;  ///< scripts may change setSweptCollisions()

  /// Draws a mix; half of all mixes have no options.
  static OptionMix random(Rng& rng);
  /// Draws the options of one Object. Every mix draws an equal number of random numbers.
  Options randomOptions(Rng& rng) const;
  Mask randomMask(Rng& rng) const;
};

}  // namespace oracle
