// Measures the time from a key to the screen if the screen shows only the last key that arrived.
#pragma once

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
  std::uint32_t press(Nanoseconds now);
  /// Records the number on the screen; nullopt if none is shown or the number is being painted.
  void look(std::optional<std::uint32_t> number, Nanoseconds now);

  /// Returns the times of the keys pressed in [from, to), in ms.
  std::vector<double> latencies(Nanoseconds from, Nanoseconds to) const;
  /// Returns how many of the keys pressed in [from, to) did not appear.
  std::size_t unanswered(Nanoseconds from, Nanoseconds to) const;

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
