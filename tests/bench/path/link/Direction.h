// One direction of the link, in virtual time: packets go in, and come out later, or never.
//
//     in -> [ is it blocked? ] -> [ lost by chance? ] -> [ drop-tail queue, rate ] -> delay + jitter -> out
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "../Monotonic.h"
#include "LinkCounters.h"

namespace bench::path {

struct DirectionOptions {
  Nanoseconds delay{};                  ///< of each packet
  Nanoseconds jitter{};                 ///< up to so much more, evenly distributed; packets keep their order
  double loss = 0;                      ///< chance of each packet to be lost, independently; 0 to 1
  std::int64_t rate_bit_s = 0;          ///< of IP packets; 0: no limit, and no queue
  std::size_t queue_bytes = 64 * 1024;  ///< what may wait to be sent
  bool block_udp = false;
  std::uint64_t seed = 1;
};

class Direction {
 public:
  /// Counts in `counters`, which must outlive it.
  Direction(const DirectionOptions& options, DirectionCounters& counters);

  /// An IP packet enters. What is not IPv4 vanishes uncounted.
  void take(std::span<const std::uint8_t> packet, Nanoseconds now);
  /// When the next packet comes out; nothing while none is under way.
  std::optional<Nanoseconds> next() const;
  /// The packet that came out first, if its time has come, and when that was. Empty: none.
  struct Delivery {
    std::vector<std::uint8_t> packet;
    Nanoseconds due{};
  };
  Delivery pop(Nanoseconds now);

 private:
  std::optional<Nanoseconds> leaves(std::size_t bytes, Nanoseconds now);
  double random() { return std::generate_canonical<double, 53>(m_random); }

  DirectionOptions m_options;
  DirectionCounters& m_counters;
  std::mt19937_64 m_random;
  Nanoseconds m_busy_until{};
  std::deque<Delivery> m_flying;  // ordered by due
};

}  // namespace bench::path
