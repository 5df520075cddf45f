// Several engines run the same scene and are timed by turns, A B C A B C …, so that a busy minute of the
// machine meets them all. Every tick that any two of them ran is compared.
//
// First all run the same number of ticks to warm up, and are compared event by event and position by
// position. Then each repetition lasts a number of ticks that is long enough to be timed; of the repetitions
// the median counts. The machine's clock is CPU time.
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
    int repetitions = 5;                    ///< that are timed
    double least_seconds = 0.05;            ///< that a repetition lasts (a tick at least)
    double most_seconds = 2;                ///< of all timed ones: a peer that has taken longer is done …
    int least_repetitions = 3;              ///< … after so many
  };

  /// What suits a world of `n` objects.
  static Rules rulesFor(int n, const Options& options);

  explicit Contest(const Rules& rules) : m_rules(rules) {}

  /// The first one is the one that the others are compared with: in time, and in what happens, unless it is
  /// another scene (`same_scene`).
  void add(const std::string& name, EnginePtr engine, bool same_scene = true);
  void run();

  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// CPU time per tick, of the engine with this name. It must be there.
  double nanosecondsPerTick(const std::string& name) const;
  /// How many times longer this engine takes than the first.
  double ratio(const std::string& name) const;
  /// Have all engines that ran whole ticks done the same?
  bool equal() const;
  /// Of the first engine: what it counted in its timed ticks, divided by their number.
  double eventsPerTick() const;
  double blockedPerTick() const;

 private:
  struct Entry {
    std::string name;
    EnginePtr engine;
    bool compared = true;
    std::vector<std::uint64_t> checksums;  // after each tick
    std::uint64_t state = 0;               // after the warm-up
    Tally warm;                            // then, too
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
