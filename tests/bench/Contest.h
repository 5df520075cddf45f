// Several engines run a scene and are timed in turn, A B C A B C …, so that a busy minute of the machine
// affects all. Every tick that any two of them ran is compared.
//
// First all run a number of warm-up ticks and are compared event by event and position by position. Then each
// repetition lasts enough ticks to be timed. The median of the repetitions counts. The clock is CPU time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Engine.h"
#include "Suite.h"

namespace bench {

class Contest {
 public:
  struct Rules {
    int warm_up_ticks = 10;
    std::size_t compared_ticks = SIZE_MAX;  ///< counted from the start, warm-up included
    int repetitions = 5;                    ///< ticks to compare, from the start with the warm-up
    double least_seconds = 0.05;            ///< a repetition takes at least this time and a tick
    double most_seconds = 2;                ///< total time after which an engine needs only the minimum
    int least_repetitions = 3;              ///< minimum number of repetitions
  };

  /// Returns suitable rules for a world of `n` objects.
  static Rules rulesFor(int n, const Options& options);

  explicit Contest(const Rules& rules) : m_rules(rules) {}

  /// Adds an engine. The others are compared with the first: their time, and what happens in them, unless
  /// they run another scene (`same_scene`).
  void add(const std::string& name, EnginePtr engine, bool same_scene = true);
  void run();

  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Returns the CPU time per tick of the engine with this name, which must exist.
  double nanosecondsPerTick(const std::string& name) const;
  /// Returns the engine's time relative to the first one's.
  double ratio(const std::string& name) const;
  /// True if all engines that ran whole ticks gave equal results.
  bool equal() const;
  /// Returns the first engine's events per timed tick.
  double eventsPerTick() const;
  double blockedPerTick() const;

 private:
  struct Entry {
    std::string name;
    EnginePtr engine;
    bool compared = true;
    std::vector<std::uint64_t> checksums;  // after each tick
    std::uint64_t state = 0;               // after the warm-up
    Tally warm;                            // after the warm-up
    int ticks_per_repetition = 1;
    std::vector<double> times;  // ns per whole tick, one per repetition
  };

  static double runTicks(Entry& entry, int ticks);
  void warmUp(Entry& entry) const;
  bool isDone(const Entry& entry) const;
  const Entry* find(const std::string& name) const;

  Rules m_rules;
  std::vector<Entry> m_entries;
};

double median(std::vector<double> values);

}  // namespace bench
