// What a link counts, for others to read while it runs (SharedFile).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace bench::path {

/// One direction. All numbers since the link began.
struct DirectionCounters {
  std::atomic<std::uint64_t> bytes{0};       ///< of IP packets that were sent, headers and lost ones included
  std::atomic<std::uint64_t> packets{0};     ///< sent
  std::atomic<std::uint64_t> lost{0};        ///< packets, by chance
  std::atomic<std::uint64_t> overflowed{0};  ///< packets that the queue had no room for
  std::atomic<std::uint64_t> blocked{0};     ///< packets, because they were UDP
};

struct LinkCounters {
  DirectionCounters down;  ///< from the server to the client
  DirectionCounters up;

  static constexpr std::size_t kLateSteps = 1000;
  static constexpr std::int64_t kLateStepNanos = 100'000;
  /// How many packets were handed over so many tenths of a millisecond after their time; the last one: or
  /// more.
  std::array<std::atomic<std::uint64_t>, kLateSteps> late{};
};

}  // namespace bench::path
