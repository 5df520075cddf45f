// One direction of a bad network: decides which packets arrive, and when.
//
// This is the model behind LossyDatagramLink and VirtualNetwork; it moves no bytes and schedules nothing.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "shared/values/SplitMix64.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {

class LossyLine {
 public:
  using Time = VirtualClock::Time;

  /// Lines with different seeds are independent: traffic on one does not affect the other.
  LossyLine(const LinkConditions& conditions, std::uint64_t seed) : conditions_(conditions), rng_(seed) {}

  /// The fate of one packet: zero, one or two arrivals.
  struct Fate {
    std::uint64_t number = 0;  ///< sequence number of the packet, from 1
    int copies = 0;
    std::array<Time, 2> arrivals{};
  };
  /// Sends a packet of `size` bytes.
  Fate send(Time now, std::size_t size);

  /// Counts a copy that reached a receiver; dropped() counts a copy for which there was no receiver.
  void delivered(std::uint64_t number);
  void dropped() { ++counters_.dropped; }

  /// Sets the conditions of packets sent from now on, not of those under way.
  void setConditions(const LinkConditions& conditions) { conditions_ = conditions; }
  const LinkCounters& counters() const { return counters_; }

 private:
  Time jitter();
  bool leave(Time now, std::size_t size, Time& departure);
  Time arrival(Time when);

  LinkConditions conditions_;
  LinkCounters counters_;
  SplitMix64 rng_;
  std::chrono::nanoseconds line_free_{0};
  Time last_arrival_{0};
  std::uint64_t newest_delivered_ = 0;
};

}  // namespace naiad
