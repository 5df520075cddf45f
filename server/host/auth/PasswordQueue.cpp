#include "host/auth/PasswordQueue.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace naiad {

std::optional<PasswordQueue::Id> PasswordQueue::add(const Guess& guess) {
  m_waiting.push_back(guess);
  if (m_waiting.size() <= m_places) return std::nullopt;
  // The newest of the worst.
  const auto worst = std::min_element(m_waiting.rbegin(), m_waiting.rend(),
                                      [this](const Guess& a, const Guess& b) { return isBetter(b, a); });
  const Id id = worst->id;
  m_waiting.erase(std::next(worst).base());
  return id;
}

std::optional<PasswordQueue::Id> PasswordQueue::takeNext() {
  // The oldest of the best.
  const auto best = std::min_element(m_waiting.begin(), m_waiting.end(),
                                     [this](const Guess& a, const Guess& b) { return isBetter(a, b); });
  if (best == m_waiting.end()) return std::nullopt;
  const Id id = best->id;
  m_waiting.erase(best);
  return id;
}

bool PasswordQueue::isBetter(const Guess& a, const Guess& b) const {
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

}  // namespace naiad
