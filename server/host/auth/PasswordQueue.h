// The guesses that wait for the one thread that compares passwords, fair by address prefix.
//
// The best guess goes next, and when there is no place for all, the worst goes away. Better is, in this
// order: one from a prefix that has players; one from a prefix with fewer guesses here (by /24, or /48 and
// /56, then by address); one from a prefix that was wrong less often lately; one from a prefix that was sent
// away less often lately; the one that came first. So prefixes that guess, or ask again and again, make room
// for those that do neither.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Not thread-safe. Uses no clock: older is what was added earlier. Work is bounded by the square of the
/// places.
class PasswordQueue {
 public:
  using Id = std::uint64_t;

  struct Guess {
    Id id = 0;
    AddressPrefix from;
    bool known = false;  ///< the prefix has players
    int wrong = 0;       ///< guesses of the prefix, lately
    int busy = 0;        ///< times that the prefix was sent away, lately
  };

  /// `places`: guesses that may wait; one or more.
  explicit PasswordQueue(std::size_t places) : m_places(places) {}

  /// The guess that goes away, if one has to: this one or another one.
  std::optional<Id> add(const Guess& guess);
  /// The guess whose turn it is; nothing if none waits.
  std::optional<Id> takeNext();
  std::size_t size() const { return m_waiting.size(); }

 private:
  bool isBetter(const Guess& a, const Guess& b) const;

  std::size_t m_places;
  std::vector<Guess> m_waiting;  ///< in the order in which they came
};

}  // namespace naiad
