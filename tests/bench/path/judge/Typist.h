// Presses keys at random times: letters, and arrows if requested.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "../Monotonic.h"

namespace bench::path {

class Typist {
 public:
  /// Mean time between two keys, distributed evenly between 0 and twice this.
  static constexpr Nanoseconds kMeanLetterGap{200'000'000};
  static constexpr Nanoseconds kMeanArrowGap{600'000'000};

  Typist(std::uint64_t seed, bool arrows, Nanoseconds now) : m_random(seed), m_arrows(arrows) {
    m_letter = now + gap(kMeanLetterGap);
    m_arrow = now + gap(kMeanArrowGap);
  }

  enum class Key { kLetter, kArrow };
  /// Returns a key that is due. Call again until it returns nullopt.
  std::optional<Key> due(Nanoseconds now) {
    if (now >= m_letter) {
      m_letter = now + gap(kMeanLetterGap);
      return Key::kLetter;
    }
    if (m_arrows && now >= m_arrow) {
      m_arrow = now + gap(kMeanArrowGap);
      return Key::kArrow;
    }
    return std::nullopt;
  }
  /// Returns when the next key is due.
  Nanoseconds next() const { return m_arrows && m_arrow < m_letter ? m_arrow : m_letter; }

 private:
  Nanoseconds gap(Nanoseconds mean) {
    const double share = std::generate_canonical<double, 53>(m_random);
    return Nanoseconds(static_cast<std::int64_t>(2 * share * static_cast<double>(mean.count())));
  }

  std::mt19937_64 m_random;
  bool m_arrows;
  Nanoseconds m_letter{};
  Nanoseconds m_arrow{};
};

}  // namespace bench::path
