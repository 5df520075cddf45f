// How long keys take to the screen, where the screen only says which key was the last one that arrived.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../Monotonic.h"

namespace bench::path {

class EchoJudge {
 public:
  /// The screen shows the number of the last key modulo `period`; of the keys that come onto it at the same
  /// time there must be fewer than that.
  explicit EchoJudge(std::uint32_t period) : m_period(period) {}

  /// A key goes into the terminal; its number, from 0 on.
  std::uint32_t press(Nanoseconds now);
  /// The screen shows this number now; nothing: none, or it is being painted.
  void look(std::optional<std::uint32_t> number, Nanoseconds now);

  /// How long the keys took that were pressed in [from, to), in ms.
  std::vector<double> latencies(Nanoseconds from, Nanoseconds to) const;
  /// Keys pressed in [from, to) that were not seen.
  std::size_t unanswered(Nanoseconds from, Nanoseconds to) const;

 private:
  struct Key {
    Nanoseconds pressed{};
    std::optional<Nanoseconds> seen;
  };
  std::uint32_t m_period;
  std::vector<Key> m_keys;
  std::size_t m_next = 0;  // the first that was not seen
};

}  // namespace bench::path
