// Runs one random world in the engine and in the oracle, and compares them after each tick.
#pragma once

#include <cstdint>
#include <string>

#include "Counters.h"
#include "engine/collision/MoverStats.h"

namespace oracle {

struct Comparison {
  /// The first difference, as text; empty if both agree.
  std::string difference;
  std::uint64_t hash = 0;  ///< hash of all events and all states
  bool with_options = false;
  std::int64_t ticks = 0;
  std::int64_t objects = 0;  ///< Objects created in the whole run
  int largest = 0;           ///< most Objects at one time
  std::int64_t handled = 0;  ///< collision and out events received by handlers
  std::int64_t births = 0;   ///< Objects created in such handlers
  std::int64_t deaths = 0;   ///< Objects marked or deleted by hand in such handlers, each counted once
  std::int64_t contacts_asked = 0;
  std::int64_t contacts_found = 0;
  std::int64_t rooms_asked = 0;
  std::int64_t rooms_found = 0;
  Counters counters;
  df::MoverStats paths;  ///< paths taken by the engine
};

/// Runs the world of `seed` in both. After each tick, compares all new events and the state of every Object,
/// in the world's order. In worlds with options it also compares firstContact() and findFree() every 8 ticks.
Comparison compareWorld(std::uint64_t seed, bool with_options);

}  // namespace oracle
