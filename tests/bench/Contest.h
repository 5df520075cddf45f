// Several engines run a scene and are timed in turn, A B C A B C …, so that other load on the machine affects
// all of them. Every tick that two of them ran is compared.
//
// First all engines run the warm-up ticks, after which their events and positions are compared. Then each
// runs several repetitions, whose number of ticks is large enough to be timed. The result is the median of
// the repetitions, in CPU time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ElapsedTime.h"
#include "Engine.h"
#include "Suite.h"

namespace bench {

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

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
  static Rules rulesFor(int n, const Options& options) {
    Rules rules;
    rules.warm_up_ticks = n <= 3000 ? 50 : n < 1'000'000 ? 3 : 1;
    if (options.quick) {
      rules.warm_up_ticks = 3;
      rules.repetitions = 3;
      rules.least_seconds = 0.01;
      rules.most_seconds = 0.1;
    }
    return rules;
  }

  explicit Contest(const Rules& rules) : m_rules(rules) {}

  /// Adds an engine. Times are compared with the first engine's. Events and positions are, too, unless the
  /// engine runs another scene (`same_scene` is false).
  void add(const std::string& name, EnginePtr engine, bool same_scene = true) {
    m_entries.emplace_back();
    Entry& entry = m_entries.back();
    entry.name = name;
    entry.compared = same_scene && engine->partOfTick() == 1;
    entry.engine = std::move(engine);
  }
  void run() {
    for (Entry& entry : m_entries) warmUp(entry);
    for (int round = 0; round < m_rules.repetitions; ++round) {
      for (Entry& entry : m_entries) {
        if (isDone(entry)) continue;
        const double time = runTicks(entry, entry.ticks_per_repetition);
        entry.times.push_back(time / entry.ticks_per_repetition / entry.engine->partOfTick());
      }
    }
  }

  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Returns the CPU time per tick of the engine with this name, which must exist.
  double nanosecondsPerTick(const std::string& name) const {
    const Entry* entry = find(name);
    if (entry == nullptr) throw std::logic_error("no engine " + name + " in this contest");
    return median(entry->times);
  }
  /// Returns the engine's time divided by the first engine's.
  double ratio(const std::string& name) const {
    return nanosecondsPerTick(name) / median(m_entries.front().times);
  }
  /// True if all engines that ran whole ticks gave equal results.
  bool equal() const {
    const Entry& first = m_entries.front();
    return std::all_of(m_entries.begin(), m_entries.end(), [&](const Entry& entry) {
      if (!entry.compared) return true;
      const auto both = static_cast<std::ptrdiff_t>(
          std::min({first.checksums.size(), entry.checksums.size(), m_rules.compared_ticks}));
      return entry.state == first.state && entry.warm.events == first.warm.events &&
             std::equal(first.checksums.begin(), first.checksums.begin() + both, entry.checksums.begin());
    });
  }
  /// Return the first engine's events and blocked moves per timed tick.
  double eventsPerTick() const { return perTick(&Tally::events); }
  double blockedPerTick() const { return perTick(&Tally::blocked); }

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

  double perTick(std::uint64_t Tally::*count) const {
    const Entry& first = m_entries.front();
    const Tally& end = first.engine->tally();
    return static_cast<double>(end.*count - first.warm.*count) /
           static_cast<double>(end.tick - first.warm.tick);
  }
  static double runTicks(Entry& entry, int ticks) {
    const double begin = cpuNanoseconds();
    for (int i = 0; i < ticks; ++i) {
      entry.engine->tick();
      entry.checksums.push_back(entry.engine->tally().checksum);
    }
    return cpuNanoseconds() - begin;
  }
  void warmUp(Entry& entry) const {
    if (entry.engine->partOfTick() == 1) runTicks(entry, m_rules.warm_up_ticks - 1);
    const double tick = runTicks(entry, 1);
    entry.ticks_per_repetition = std::max(1, static_cast<int>(std::ceil(m_rules.least_seconds * 1e9 / tick)));
    entry.state = entry.engine->stateHash();
    entry.warm = entry.engine->tally();
  }
  bool isDone(const Entry& entry) const {
    const auto done = static_cast<int>(entry.times.size());
    if (&entry == m_entries.data() || done < m_rules.least_repetitions) return done >= m_rules.repetitions;
    const double spent = std::accumulate(entry.times.begin(), entry.times.end(), 0.0) *
                         entry.ticks_per_repetition * entry.engine->partOfTick();
    return done >= m_rules.repetitions || spent > m_rules.most_seconds * 1e9;
  }
  const Entry* find(const std::string& name) const {
    for (const Entry& entry : m_entries) {
      if (entry.name == name) return &entry;
    }
    return nullptr;
  }

  Rules m_rules;
  std::vector<Entry> m_entries;
};

}  // namespace bench
