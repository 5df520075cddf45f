// The events of a world, in order: a running hash and, on request, every entry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "Rng.h"
#include "shared/values/Fixed.h"

namespace oracle {

enum class Happening { STEP, COLLISION, OUT, MOVED, DESTROYED };

struct Entry {
  Happening what = Happening::STEP;
  int receiver = 0;            ///< Object that receives the event; for MOVED the mover
  int object1 = 0;             ///< mover of a COLLISION
  int object2 = 0;             ///< other Object of a COLLISION
  df::FixedVector where = {};  ///< position of a COLLISION; target of MOVED
  int result = 0;              ///< result of moveObject() (MOVED)

  friend bool operator==(const Entry&, const Entry&) = default;
};

/// Formats an entry, for example "collision to 3: 3 onto 7 at (1.5, 2)".
std::string toString(const Entry& entry);

class EventLog {
 public:
  /// Keeps the entries, not only their hash.
  void keepEntries() { m_keep = true; }

  void add(const Entry& entry) {
    ++m_count;
    if (m_keep) m_entries.push_back(entry);
    mixIn(static_cast<std::uint64_t>(entry.what) ^ static_cast<std::uint64_t>(entry.receiver) << 8);
    if (entry.what == Happening::STEP || entry.what == Happening::OUT) return;
    mixIn(static_cast<std::uint64_t>(entry.object1) << 32 ^ static_cast<std::uint64_t>(entry.object2));
    mixIn(static_cast<std::uint64_t>(entry.where.x));
    mixIn(static_cast<std::uint64_t>(entry.where.y));
    mixIn(static_cast<std::uint64_t>(entry.result));
  }

  std::uint64_t hash() const { return m_hash; }
  std::int64_t count() const { return m_count; }
  const std::vector<Entry>& entries() const { return m_entries; }

 private:
  void mixIn(std::uint64_t value) { m_hash = mix(m_hash ^ value); }

  std::uint64_t m_hash = 0;
  std::int64_t m_count = 0;
  bool m_keep = false;
  std::vector<Entry> m_entries;
};

/// Describes the first element in which the two differ, after up to `common` common ones. Empty if none does.
template <class Element, class Text>
std::string firstDifference(const std::vector<Element>& engine, const std::vector<Element>& oracle,
                            std::size_t common, Text textOf) {
  std::size_t i = 0;
  while (i < engine.size() && i < oracle.size() && engine[i] == oracle[i]) ++i;
  if (i == engine.size() && i == oracle.size()) return {};
  std::string text;
  for (std::size_t k = i - std::min(i, common); k < i; ++k) text += "  both    " + textOf(engine[k]) + '\n';
  text += "  engine  " + (i < engine.size() ? textOf(engine[i]) : "nothing more") + '\n';
  return text + "  oracle  " + (i < oracle.size() ? textOf(oracle[i]) : "nothing more") + '\n';
}

}  // namespace oracle
