// Conditions of a network in virtual time, and counters of its traffic.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace naiad {

/// The network in one direction. The default is perfect: nothing lost, no delay, no limit.
struct LinkConditions {
  std::chrono::microseconds delay{0};   ///< delay in one direction
  std::chrono::microseconds jitter{0};  ///< added to each packet's delay: uniform in 0 … jitter
  bool reorder = true;                  ///< jitter may let packets overtake; false: they stay in order
  double loss = 0;                      ///< probability, 0 … 1, that a packet vanishes
  double duplicate = 0;                 ///< probability, 0 … 1, that a packet arrives twice (datagrams)
  std::uint64_t rate = 0;               ///< bytes of payload per second; 0 = unlimited
  /// Bytes of datagrams that may wait for the line if `rate` is set; packets that do not fit are dropped.
  std::size_t queue = 65'536;
  /// Bytes of a stream that may be under way unacknowledged; further bytes stay unsent at the sender.
  std::size_t window = 65'536;
};

/// Packets in one direction so far: sent + duplicated = delivered + dropped + under way.
struct LinkCounters {
  std::uint64_t sent = 0;        ///< packets passed to send()
  std::uint64_t delivered = 0;   ///< packets passed to the receiver, second copies included
  std::uint64_t dropped = 0;     ///< lost, queue full, or no receiver
  std::uint64_t duplicated = 0;  ///< number of second copies made
  std::uint64_t reordered = 0;   ///< delivered after a later packet
};

}  // namespace naiad
