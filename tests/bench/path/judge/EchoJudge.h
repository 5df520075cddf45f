// Measures the time from a key to the screen if the screen shows only the last key that arrived.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../Monotonic.h"

namespace bench::path {

class EchoJudge {
 public:
  /// The screen shows the number of the last key modulo `period`. Between two frames, fewer than `period`
  /// keys may arrive.
  explicit EchoJudge(std::uint32_t period) : m_period(period) {}

  /// Records a pressed key. Returns its number, from 0 on.
  std::uint32_t press(Nanoseconds now) {
    m_keys.push_back({now, std::nullopt});
    return static_cast<std::uint32_t>(m_keys.size() - 1);
  }
  /// Records the number on the screen; nullopt if none is shown or the number is being painted.
  void look(std::optional<std::uint32_t> number, Nanoseconds now) {
    if (!number || (m_next > 0 && (m_next - 1) % m_period == *number)) return;
    // Two keys may have arrived between two frames. Then the frame shows only the later key, and the earlier
    // one has arrived, too.
    const std::size_t end = std::min(m_keys.size(), m_next + m_period - 1);
    for (std::size_t i = m_next; i < end; ++i) {
      if (i % m_period != *number) continue;
      for (; m_next <= i; ++m_next) m_keys[m_next].seen = now;
      return;
    }
  }

  /// Returns the times of the keys pressed in [from, to), in ms.
  std::vector<double> latencies(Nanoseconds from, Nanoseconds to) const {
    std::vector<double> result;
    for (const Key& key : m_keys) {
      if (key.seen && key.pressed >= from && key.pressed < to)
        result.push_back(milliseconds(*key.seen - key.pressed));
    }
    return result;
  }
  /// Returns how many of the keys pressed in [from, to) did not appear.
  std::size_t unanswered(Nanoseconds from, Nanoseconds to) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        m_keys, [&](const Key& key) { return !key.seen && key.pressed >= from && key.pressed < to; }));
  }

 private:
  struct Key {
    Nanoseconds pressed{};
    std::optional<Nanoseconds> seen;
  };
  std::uint32_t m_period;
  std::vector<Key> m_keys;
  std::size_t m_next = 0;  // the first key that has not appeared
};

}  // namespace bench::path
