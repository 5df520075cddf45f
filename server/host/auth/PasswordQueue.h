// The guesses that wait for the thread that compares passwords, fair by network (/24 or /48) and address
// prefix.
//
// The best guess is next; if the queue is full, the worst is dropped. In this order, a guess is better if its
// prefix has players, has fewer guesses in the queue (by /24, or /48 and /56, then by address), if its
// network has waited longer, or if the guess arrived first. A network waits from its first guess until its
// turn, when one of its guesses is compared. A pause of more than kMaxPause between guesses ends the wait:
// clients that retry pass those that only knock. After n recent wrong guesses, a network waits n * n *
// kWrongDelay longer.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <tuple>
#include <vector>

#include "shared/net/base/PrefixLruMap.h"

namespace naiad {

/// Not thread-safe. Time is passed in. Work is at most quadratic in `capacity`, and logarithmic in
/// `networks`.
class PasswordQueue {
 public:
  using Id = std::uint64_t;
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kMaxPause{10};  ///< five times a client's longest pause
  static constexpr std::chrono::seconds kWrongDelay{10};
  static constexpr int kMaxWrong = 60;  ///< higher numbers of wrong guesses have no further effect

  struct Guess {
    Id id = 0;
    AddressPrefix from;
    bool known = false;  ///< the prefix has players
    int wrong = 0;       ///< recent wrong guesses of the network
  };

  /// `capacity`: maximum number of waiting guesses. `networks`: number of networks whose wait is known; then
  /// the one that has not guessed for longest is forgotten. Both are at least one.
  PasswordQueue(std::size_t capacity, std::size_t networks) : m_capacity(capacity), m_networks(networks) {}

  /// Adds a guess. Returns the guess that was dropped, if any; it may be the new one.
  std::optional<Id> add(const Guess& guess, Time now) {
    const int wrong = std::min(guess.wrong, kMaxWrong);
    m_waiting.push_back({guess, waitingSince(guess.from, now) + wrong * wrong * kWrongDelay});
    if (m_waiting.size() <= m_capacity) return std::nullopt;
    // The newest of the worst guesses.
    const auto worst = std::min_element(m_waiting.rbegin(), m_waiting.rend(),
                                        [this](const auto& a, const auto& b) { return isBetter(b, a); });
    const Id id = worst->guess.id;
    m_networks.use(worst->guess.from.widest()).latest = now;  // its pause begins now
    m_waiting.erase(std::next(worst).base());
    return id;
  }
  /// Removes and returns the next guess; nullopt if none waits.
  std::optional<Id> popNext() {
    // The oldest of the best guesses.
    const auto best = std::min_element(m_waiting.begin(), m_waiting.end(),
                                       [this](const auto& a, const auto& b) { return isBetter(a, b); });
    if (best == m_waiting.end()) return std::nullopt;
    const Guess next = best->guess;
    m_waiting.erase(best);
    // The network had its turn.
    m_networks.erase(next.from.widest());
    for (WaitingGuess& other : m_waiting) {
      if (other.guess.from.widest() == next.from.widest()) other.since = Time::max();
    }
    return next.id;
  }
  std::size_t size() const { return m_waiting.size(); }

 private:
  struct WaitingGuess {
    Guess guess;
    Time since;  ///< start of the network's wait, plus the delay for wrong guesses
  };
  struct Wait {
    std::optional<Time> since;
    Time latest{};  ///< the latest time at which a guess arrived or was dropped
  };

  /// Records that a client of the network waits. Returns the start of the wait.
  Time waitingSince(const AddressPrefix& from, Time now) {
    Wait& wait = m_networks.use(from.widest());
    if (!wait.since || now - wait.latest > kMaxPause) wait.since = now;
    wait.latest = now;
    return *wait.since;
  }
  bool isBetter(const WaitingGuess& a, const WaitingGuess& b) const {
    const auto rank = [this](const WaitingGuess& waiting) {
      const Guess& guess = waiting.guess;
      const auto sharing = [&](auto width) {
        return std::count_if(m_waiting.begin(), m_waiting.end(), [&](const WaitingGuess& other) {
          return width(other.guess.from) == width(guess.from);
        });
      };
      return std::tuple(!guess.known, sharing([](const AddressPrefix& p) { return p.widest(); }),
                        sharing([](const AddressPrefix& p) { return p.wide(); }),
                        sharing([](const AddressPrefix& p) { return p; }), waiting.since);
    };
    return rank(a) < rank(b);
  }

  std::size_t m_capacity;
  std::vector<WaitingGuess> m_waiting;  ///< in order of arrival
  PrefixLruMap<Wait> m_networks;        ///< networks that wait, by AddressPrefix::widest()
};

}  // namespace naiad
