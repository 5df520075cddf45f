#include "Comparison.h"

#include <algorithm>
#include <sstream>

#include "EngineDriver.h"
#include "OracleDriver.h"

namespace oracle {
namespace {

std::string toString(const Snapshot& state) {
  std::ostringstream text;
  text.precision(17);
  const auto pair = [&](const char* name, FixedVector v) {
    text << ' ' << name << " (" << df::toCells(v.x) << ", " << df::toCells(v.y) << ')';
  };
  text << state.id << ':';
  pair("position", state.position);
  pair("velocity", state.velocity);
  pair("corner", state.box.corner);
  pair("size", state.box.size);
  text << " solidness " << state.solidness << " no_soft " << state.no_soft << " active " << state.active;
  return text.str();
}

std::string firstDifference(const std::vector<Snapshot>& engine, const std::vector<Snapshot>& oracle) {
  std::size_t i = 0;
  while (i < engine.size() && i < oracle.size() && engine[i] == oracle[i]) ++i;
  if (i == engine.size() && i == oracle.size()) return {};
  const auto at = [&](const std::vector<Snapshot>& states) {
    return i < states.size() ? toString(states[i]) : "no more Objects";
  };
  std::ostringstream text;
  text << "  engine  " << at(engine) << "\n  oracle  " << at(oracle) << '\n';
  return text.str();
}

std::uint64_t hashOf(const std::vector<Snapshot>& states, std::uint64_t hash) {
  for (const Snapshot& state : states) {
    hash = mix(hash ^ static_cast<std::uint64_t>(state.position.x));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.position.y));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.velocity.x));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.velocity.y));
  }
  return hash;
}

/// With `explain`, keep what is needed to say where the two part.
Comparison run(std::uint64_t seed, bool explain) {
  const RandomWorld world(seed);
  EngineDriver engine(world);
  OracleDriver oracle(world);
  if (explain) {
    engine.script().log().keepEntries();
    oracle.script().log().keepEntries();
  }

  Comparison result;
  bool equal = true;
  while (equal && result.ticks < world.ticks) {
    engine.tick();
    oracle.tick();
    ++result.ticks;
    const std::vector<Snapshot> engine_states = engine.snapshot();
    const std::vector<Snapshot> oracle_states = oracle.snapshot();
    equal = engine.script().log().hash() == oracle.script().log().hash() && engine_states == oracle_states;
    result.hash = hashOf(engine_states, result.hash);
    if (engine.refusals() != 0) {
      result.difference = "seed " + std::to_string(seed) + ": the engine refused a number that is in range\n";
      return result;
    }
    if (equal) continue;

    result.difference = "seed " + std::to_string(seed) + ", tick " + std::to_string(result.ticks) + ", " +
                        std::to_string(world.objects.size()) + " Objects at first\n" +
                        firstDifference(engine.script().log(), oracle.script().log()) +
                        firstDifference(engine_states, oracle_states);
  }

  const Script& script = oracle.script();
  result.hash = mix(result.hash ^ engine.script().log().hash());
  result.objects = script.created();
  result.largest = script.largest();
  result.handled = script.handled();
  result.births = script.births();
  result.deaths = script.deaths();
  result.counters = oracle.counters();
  return result;
}

}  // namespace

Comparison compareWorld(std::uint64_t seed) {
  Comparison result = run(seed, false);
  if (!result.difference.empty()) result.difference = run(seed, true).difference;
  return result;
}

}  // namespace oracle
