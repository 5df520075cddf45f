// One direction of the link, in virtual time: packets enter, and come out later or never.
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
  Nanoseconds delay{};          ///< added to each packet
  Nanoseconds jitter{};         ///< maximum additional delay, distributed evenly without reordering
  double loss = 0;              ///< probability that a packet is lost, independently; 0 to 1
  std::int64_t rate_bit_s = 0;  ///< bits per second, counting whole IP packets; 0: no limit and no queue
  std::size_t queue_bytes = 64 * 1024;  ///< bytes that may wait to be sent
  bool block_udp = false;
  std::uint64_t seed = 1;
};

class Direction {
 public:
  /// Counts packets in `counters`, which must outlive the Direction.
  Direction(const DirectionOptions& options, DirectionCounters& counters);

  /// Accepts an IP packet. Packets other than IPv4 are dropped without being counted.
  void take(std::span<const std::uint8_t> packet, Nanoseconds now);
  /// Returns when the next packet comes out; nullopt while none is under way.
  std::optional<Nanoseconds> next() const;
  /// A packet that came out, and when it was due. `packet` is empty if none was due.
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
  std::deque<Delivery> m_flying;  // packets under way, ordered by `due`
};

}  // namespace bench::path
