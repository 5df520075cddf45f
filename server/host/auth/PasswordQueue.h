// The guesses that wait for the one thread that compares passwords, fair by address prefix.
//
// The best guess goes next, and when there is no place for all, the worst goes away. Better is, in this
// order: one from a prefix that has players; one from a prefix with fewer guesses here (by /24, or /48 and
// /56, then by address); one from a prefix that was wrong less often lately; one from a prefix that was sent
// away less often lately; the one that came first. So prefixes that guess, or ask again and again, make room
// for those that do neither.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <tuple>
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
  std::optional<Id> add(const Guess& guess) {
    m_waiting.push_back(guess);
    if (m_waiting.size() <= m_places) return std::nullopt;
    // The newest of the worst.
    const auto worst = std::min_element(m_waiting.rbegin(), m_waiting.rend(),
                                        [this](const Guess& a, const Guess& b) { return isBetter(b, a); });
    const Id id = worst->id;
    m_waiting.erase(std::next(worst).base());
    return id;
  }
  /// The guess whose turn it is; nothing if none waits.
  std::optional<Id> takeNext() {
    // The oldest of the best.
    const auto best = std::min_element(m_waiting.begin(), m_waiting.end(),
                                       [this](const Guess& a, const Guess& b) { return isBetter(a, b); });
    if (best == m_waiting.end()) return std::nullopt;
    const Id id = best->id;
    m_waiting.erase(best);
    return id;
  }
  std::size_t size() const { return m_waiting.size(); }

 private:
  bool isBetter(const Guess& a, const Guess& b) const {
    const auto rank = [this](const Guess& guess) {
      const auto sharing = [&](auto width) {
        return std::count_if(m_waiting.begin(), m_waiting.end(),
                             [&](const Guess& other) { return width(other.from) == width(guess.from); });
      };
      return std::tuple(!guess.known, sharing([](const AddressPrefix& p) { return p.widest(); }),
                        sharing([](const AddressPrefix& p) { return p.wide(); }),
                        sharing([](const AddressPrefix& p) { return p; }), guess.wrong, guess.busy);
    };
    return rank(a) < rank(b);
  }

  std::size_t m_places;
  std::vector<Guess> m_waiting;  ///< in the order in which they came
};

}  // namespace naiad
