// Engine and oracle in the same random world, tick by tick.
#pragma once

#include <cstdint>
#include <string>

#include "Counters.h"
#include "engine/collision/MoverStats.h"

namespace oracle {

struct Comparison {
  /// Empty if nothing differed; otherwise what did first, for a person to read.
  std::string difference;
  std::uint64_t hash = 0;  ///< of all events and all states
  bool with_options = false;
  std::int64_t ticks = 0;
  std::int64_t objects = 0;  ///< that ever were
  int largest = 0;           ///< most Objects at one time
  std::int64_t handled = 0;  ///< collision and out events received by handlers
  std::int64_t births = 0;   ///< within such handlers
  std::int64_t deaths = 0;   ///< within such handlers: marked or deleted by hand, once each
  std::int64_t contacts_asked = 0;
  std::int64_t contacts_found = 0;
  std::int64_t rooms_asked = 0;
  std::int64_t rooms_found = 0;
  Counters counters;
  df::MoverStats paths;  ///< of the engine
};

/// Run the world of `seed` in both and compare, after each tick, every event since the last and the state of
/// every Object, in the world's order; and now and then what firstContact() and findFree() say, which worlds
/// without options never ask.
Comparison compareWorld(std::uint64_t seed, bool with_options);

}  // namespace oracle
