#include "Comparison.h"

#include <cmath>
#include <sstream>

#include "EngineDriver.h"
#include "OracleDriver.h"

namespace oracle {
namespace {

std::ostream& operator<<(std::ostream& out, FixedVector v) {
  return out << '(' << df::toCells(v.x) << ", " << df::toCells(v.y) << ')';
}

std::string toString(const Snapshot& state) {
  std::ostringstream text;
  text.precision(17);
  text << state.id << ": position " << state.position << " velocity " << state.velocity << " corner "
       << state.box.corner << " size " << state.box.size << " solidness " << state.solidness << " no_soft "
       << state.no_soft << " active " << state.active << " swept " << state.options.swept << " precise "
       << state.options.precise << " rest_contacts " << state.options.rest_contacts << " may_move_out "
       << state.options.may_move_out;
  return text.str();
}

constexpr std::size_t kCommonEvents = 8;  // shown before the first one that differs

std::uint64_t hashOf(const std::vector<Snapshot>& states, std::uint64_t hash) {
  for (const Snapshot& state : states) {
    hash = mix(hash ^ static_cast<std::uint64_t>(state.position.x));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.position.y));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.velocity.x));
    hash = mix(hash ^ static_cast<std::uint64_t>(state.velocity.y));
  }
  return hash;
}

/// Calls firstContact() of both worlds. Returns the difference as text; "" if there is no difference.
std::string compareContact(Actor& engine, Actor& oracle, int id, FixedVector where, Comparison& result) {
  const Meeting a = engine.firstContact(id, where);
  const Meeting b = oracle.firstContact(id, where);
  ++result.contacts_asked;
  if (b.id >= 0) ++result.contacts_found;
  // Equal fractions with different denominators may differ in the last digit of the quotient.
  if (a.id == b.id && a.position == b.position && std::abs(a.time - b.time) <= 1e-15) return {};
  std::ostringstream text;
  text.precision(17);
  text << "  firstContact of " << id << " on its path to " << where << "\n  engine  " << a.id << " at "
       << a.time << ", stands at " << a.position << "\n  oracle  " << b.id << " at " << b.time
       << ", stands at " << b.position << '\n';
  return text.str();
}

std::string compareRoom(Actor& engine, Actor& oracle, const FixedBox& box, FixedVector near,
                        Comparison& result) {
  const auto a = engine.findFree(box, near);
  const auto b = oracle.findFree(box, near);
  ++result.rooms_asked;
  if (b) ++result.rooms_found;
  if (a == b) return {};
  std::ostringstream text;
  text.precision(17);
  const auto say = [&](const std::optional<FixedVector>& found) {
    if (found) text << *found;
    if (!found) text << "nothing";
  };
  text << "  findFree of corner " << box.corner << " size " << box.size << " near " << near << "\n  engine  ";
  say(a);
  text << "\n  oracle  ";
  say(b);
  text << '\n';
  return text.str();
}

/// Compares firstContact() of three random Objects, and findFree() near the first of them.
std::string compareQuestions(const RandomWorld& world, EngineDriver& engine, OracleDriver& oracle,
                             Comparison& result) {
  Rng rng(mix(world.seed ^ mix(static_cast<std::uint64_t>(result.ticks) << 40)));
  std::string difference;
  const std::vector<int> present = oracle.script().present();
  for (int i = 0; i < 3 && !present.empty() && difference.empty(); ++i) {
    const int id = present[static_cast<std::size_t>(rng.below(static_cast<int>(present.size())))];
    const FixedVector position = oracle.getPosition(id);
    FixedVector where = rng.chance(30) ? world.randomPosition(rng) : position;
    if (!world.isLost(position)) where = where + world.randomVelocity(rng);
    difference = compareContact(engine, oracle, id, where, result);
    if (i == 0) difference += compareRoom(engine, oracle, world.randomBox(rng), position, result);
  }
  return difference;
}

/// Runs both worlds to the end or until they differ. With `explain`, keeps all log entries to name the first
/// difference.
Comparison run(const RandomWorld& world, bool explain) {
  EngineDriver engine(world);
  OracleDriver oracle(world);
  if (explain) {
    engine.script().log().keepEntries();
    oracle.script().log().keepEntries();
  }

  Comparison result;
  result.with_options = world.options.any;
  while (result.difference.empty() && result.ticks < world.ticks) {
    engine.tick();
    oracle.tick();
    ++result.ticks;
    const std::vector<Snapshot> engine_states = engine.snapshot();
    const std::vector<Snapshot> oracle_states = oracle.snapshot();
    result.hash = hashOf(engine_states, result.hash);
    const bool one_switch = engine.getSweptCollisions() == oracle.getSweptCollisions();
    if (engine.script().log().hash() != oracle.script().log().hash() || engine_states != oracle_states ||
        !one_switch) {
      const auto text = [](const auto& its) { return toString(its); };
      result.difference = firstDifference(engine.script().log().entries(), oracle.script().log().entries(),
                                          kCommonEvents, text) +
                          firstDifference(engine_states, oracle_states, 0, text) +
                          (one_switch ? "" : "  the switch for sweeps\n");
    }
    if (result.difference.empty() && world.options.any && result.ticks % 8 == 0) {
      result.difference = compareQuestions(world, engine, oracle, result);
    }
    if (engine.refusals() != 0) result.difference += "  the engine refused a number that is in range\n";
  }
  if (!result.difference.empty()) {
    result.difference = "seed " + std::to_string(world.seed) + ", tick " + std::to_string(result.ticks) +
                        ", " + std::to_string(world.objects.size()) + " Objects at first" +
                        (world.options.any ? ", with options\n" : "\n") + result.difference;
  }

  const Script& script = oracle.script();
  result.hash = mix(result.hash ^ engine.script().log().hash());
  result.objects = script.created();
  result.largest = script.largest();
  result.handled = script.handled();
  result.births = script.births();
  result.deaths = script.deaths();
  result.counters = oracle.counters();
  result.paths = engine.moverStats();
  return result;
}

}  // namespace

Comparison compareWorld(std::uint64_t seed, bool with_options) {
  const RandomWorld world(seed, with_options);
  Comparison result = run(world, false);
  if (!result.difference.empty()) result.difference = run(world, true).difference;
  return result;
}

}  // namespace oracle
