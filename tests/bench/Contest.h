// Several engines run a scene and are timed in turn, A B C A B C …, so that other load on the machine affects
// all of them. Every tick that two of them ran is compared.
//
// First all engines run the warm-up ticks, after which their events and positions are compared. Then each
// runs several repetitions, whose number of ticks is large enough to be timed. The result is the median of
// the repetitions, in CPU time.
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
    std::size_t compared_ticks = SIZE_MAX;  ///< ticks to compare, counted from the start of the warm-up
    int repetitions = 5;                    ///< number of repetitions
    double least_seconds = 0.05;            ///< minimum time of a repetition, which has at least one tick
    double most_seconds = 2;                ///< after this total time, least_repetitions are enough
    int least_repetitions = 3;              ///< minimum of repetitions, except for the first engine
  };

  /// Returns rules that suit a world of `n` objects.
  static Rules rulesFor(int n, const Options& options);

  explicit Contest(const Rules& rules) : m_rules(rules) {}

  /// Adds an engine. Times are compared with the first engine's. Events and positions are, too, unless the
  /// engine runs another scene (`same_scene` is false).
  void add(const std::string& name, EnginePtr engine, bool same_scene = true);
  void run();

  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Returns the CPU time per tick of the engine with this name, which must exist.
  double nanosecondsPerTick(const std::string& name) const;
  /// Returns the engine's time divided by the first engine's.
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
