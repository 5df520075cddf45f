// Counters of a link, which other processes read while it runs (SharedFile).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace bench::path {

/// Counters of one direction since the link began.
struct DirectionCounters {
  std::atomic<std::uint64_t> bytes{0};       ///< bytes of IP packets sent, with headers, including lost ones
  std::atomic<std::uint64_t> packets{0};     ///< packets sent, including lost ones
  std::atomic<std::uint64_t> lost{0};        ///< packets lost by chance
  std::atomic<std::uint64_t> overflowed{0};  ///< packets for which the queue had no space
  std::atomic<std::uint64_t> blocked{0};     ///< packets dropped because they were UDP
};

struct LinkCounters {
  DirectionCounters down;  ///< from server to client
  DirectionCounters up;

  static constexpr std::size_t kLateSteps = 1000;
  static constexpr std::int64_t kLateStepNanos = 100'000;
  /// Number of packets by delay beyond their time, in tenths of a millisecond. The last element includes all
  /// longer delays.
  std::array<std::atomic<std::uint64_t>, kLateSteps> late{};
};

}  // namespace bench::path
