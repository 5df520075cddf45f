// What a network in virtual time does to what is sent over it, and what it has done.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace naiad {

/// The network in one direction. The default is perfect: nothing lost, no delay, no limit.
struct LinkConditions {
  std::chrono::microseconds delay{0};   ///< one way
  std::chrono::microseconds jitter{0};  ///< added to each packet's delay: uniform in 0 … jitter
  bool reorder = true;                  ///< jitter may let packets overtake; false: they queue up behind
  double loss = 0;                      ///< probability, 0 … 1, that a packet vanishes
  double duplicate = 0;                 ///< probability, 0 … 1, that one arrives twice (datagrams only)
  std::uint64_t rate = 0;               ///< bytes of payload per second; 0 = unlimited
  /// Datagrams, with a rate: bytes that may wait for the line; what does not fit is dropped (drop-tail).
  std::size_t queue = 65'536;
  /// Streams: bytes that may be under way unacknowledged; what exceeds it stays unsent with the sender.
  std::size_t window = 65'536;
};

/// What happened in one direction so far. Datagrams: sent + duplicated = delivered + dropped + under way.
struct LinkCounters {
  std::uint64_t sent = 0;        ///< packets or frames given to send()
  std::uint64_t delivered = 0;   ///< handed to the receiving end, second copies included
  std::uint64_t dropped = 0;     ///< lost, no room in the queue, or no receiver. Streams: lost and sent again
  std::uint64_t duplicated = 0;  ///< second copies made
  std::uint64_t reordered =
      0;  ///< delivered after one that was sent later. Streams: held back for an earlier one
};

}  // namespace naiad
