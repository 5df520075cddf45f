// The guesses that wait for the thread that compares passwords, fair by address prefix.
//
// The best guess is next; if the queue is full, the worst is dropped. In this order, a guess is better if its
// prefix has players, has fewer guesses in the queue (by /24, or /48 and /56, then by address), was wrong
// less often lately, was dropped less often lately, or if the guess arrived first. So the guesses of prefixes
// that guess or retry a lot are dropped first.
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

/// Not thread-safe. Uses no clock: older means added earlier. Work is at most quadratic in `capacity`.
class PasswordQueue {
 public:
  using Id = std::uint64_t;

  struct Guess {
    Id id = 0;
    AddressPrefix from;
    bool known = false;  ///< the prefix has players
    int wrong = 0;       ///< recent wrong guesses of the prefix
    int busy = 0;        ///< recent dropped guesses of the prefix
  };

  /// `capacity`: maximum number of waiting guesses; at least one.
  explicit PasswordQueue(std::size_t capacity) : m_capacity(capacity) {}

  /// Adds a guess. Returns the guess that was dropped, if any; it may be the new one.
  std::optional<Id> add(const Guess& guess) {
    m_waiting.push_back(guess);
    if (m_waiting.size() <= m_capacity) return std::nullopt;
    // The newest of the worst guesses.
    const auto worst = std::min_element(m_waiting.rbegin(), m_waiting.rend(),
                                        [this](const Guess& a, const Guess& b) { return isBetter(b, a); });
    const Id id = worst->id;
    m_waiting.erase(std::next(worst).base());
    return id;
  }
  /// Removes and returns the next guess; nullopt if none waits.
  std::optional<Id> popNext() {
    // The oldest of the best guesses.
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

  std::size_t m_capacity;
  std::vector<Guess> m_waiting;  ///< in order of arrival
};

}  // namespace naiad
