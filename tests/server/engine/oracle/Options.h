// What an Object asks for beyond the book (docs/collisions.md), and how many Objects of a world ask for it.
#pragma once

#include "OracleMask.h"
#include "Rng.h"

namespace oracle {

/// What one Object asks for.
struct Options {
  bool swept = false;
  bool precise = false;
  bool rest_contacts = false;
  bool may_move_out = false;

  friend bool operator==(const Options&, const Options&) = default;
};

/// Of a world: percent of its Objects, and what its scripts may do.
struct OptionMix {
  bool any = false;  ///< none of all this otherwise
  int swept = 0;
  int precise = 0;
  int masked = 0;
  int rest_contacts = 0;
  int may_move_out = 0;
  bool sweep_all = false;      ///< the world's switch, at first
  bool scripts_sweep = false;  ///< may scripts turn it?

  /// Half of all mixes are without any.
  static OptionMix random(Rng& rng);
  /// However the mix, as many random numbers are drawn.
  Options randomOptions(Rng& rng) const;
  Mask randomMask(Rng& rng) const;
};

}  // namespace oracle
