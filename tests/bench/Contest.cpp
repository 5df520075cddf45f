#include "Contest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "ElapsedTime.h"

namespace bench {

Contest::Rules Contest::rulesFor(int n, const Options& options) {
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

void Contest::add(const std::string& name, EnginePtr engine, bool same_scene) {
  m_entries.emplace_back();
  Entry& entry = m_entries.back();
  entry.name = name;
  entry.compared = same_scene && engine->partOfTick() == 1;
  entry.engine = std::move(engine);
}

double Contest::runTicks(Entry& entry, int ticks) {
  const double begin = cpuNanoseconds();
  for (int i = 0; i < ticks; ++i) {
    entry.engine->tick();
    entry.checksums.push_back(entry.engine->tally().checksum);
  }
  return cpuNanoseconds() - begin;
}

void Contest::warmUp(Entry& entry) const {
  if (entry.engine->partOfTick() == 1) runTicks(entry, m_rules.warm_up_ticks - 1);
  const double tick = runTicks(entry, 1);
  entry.ticks_per_repetition = std::max(1, static_cast<int>(std::ceil(m_rules.least_seconds * 1e9 / tick)));
  entry.state = entry.engine->stateHash();
  entry.warm = entry.engine->tally();
}

bool Contest::isDone(const Entry& entry) const {
  const auto done = static_cast<int>(entry.times.size());
  if (&entry == m_entries.data() || done < m_rules.least_repetitions) return done >= m_rules.repetitions;
  const double spent = std::accumulate(entry.times.begin(), entry.times.end(), 0.0) *
                       entry.ticks_per_repetition * entry.engine->partOfTick();
  return done >= m_rules.repetitions || spent > m_rules.most_seconds * 1e9;
}

void Contest::run() {
  for (Entry& entry : m_entries) warmUp(entry);
  for (int round = 0; round < m_rules.repetitions; ++round) {
    for (Entry& entry : m_entries) {
      if (isDone(entry)) continue;
      const double time = runTicks(entry, entry.ticks_per_repetition);
      entry.times.push_back(time / entry.ticks_per_repetition / entry.engine->partOfTick());
    }
  }
}

const Contest::Entry* Contest::find(const std::string& name) const {
  for (const Entry& entry : m_entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

double Contest::nanosecondsPerTick(const std::string& name) const {
  const Entry* entry = find(name);
  if (entry == nullptr) throw std::logic_error("no engine " + name + " in this contest");
  return median(entry->times);
}

double Contest::ratio(const std::string& name) const {
  return nanosecondsPerTick(name) / median(m_entries.front().times);
}

bool Contest::equal() const {
  const Entry& first = m_entries.front();
  return std::all_of(m_entries.begin(), m_entries.end(), [&](const Entry& entry) {
    if (!entry.compared) return true;
    const auto both = static_cast<std::ptrdiff_t>(
        std::min({first.checksums.size(), entry.checksums.size(), m_rules.compared_ticks}));
    return entry.state == first.state && entry.warm.events == first.warm.events &&
           std::equal(first.checksums.begin(), first.checksums.begin() + both, entry.checksums.begin());
  });
}

double Contest::eventsPerTick() const {
  const Entry& first = m_entries.front();
  const Tally& end = first.engine->tally();
  return static_cast<double>(end.events - first.warm.events) /
         static_cast<double>(end.tick - first.warm.tick);
}

double Contest::blockedPerTick() const {
  const Entry& first = m_entries.front();
  const Tally& end = first.engine->tally();
  return static_cast<double>(end.blocked - first.warm.blocked) /
         static_cast<double>(end.tick - first.warm.tick);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace bench
