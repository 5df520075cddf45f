// Engine and oracle in the same random world, tick by tick.
#pragma once

#include <cstdint>
#include <string>

#include "Oracle.h"

namespace oracle {

struct Comparison {
  /// Empty if nothing differed; otherwise what did first, for a person to read.
  std::string difference;
  std::uint64_t hash = 0;  ///< of all events and all states
  std::int64_t ticks = 0;
  std::int64_t objects = 0;  ///< that ever were
  int largest = 0;           ///< most Objects at one time
  std::int64_t handled = 0;  ///< collision and out events received by handlers
  std::int64_t births = 0;   ///< within such handlers
  std::int64_t deaths = 0;   ///< within such handlers: marked or deleted by hand, once each
  Counters counters;
};

/// Run the world of `seed` in both and compare, after each tick, every event since the last and the state of
/// every Object, in the world's order.
Comparison compareWorld(std::uint64_t seed);

}  // namespace oracle
