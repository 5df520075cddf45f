// One direction of a bad network: what becomes of each packet, and when it arrives.
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

  /// Lines with different seeds have nothing to do with each other: traffic on one changes nothing on the
  /// other.
  LossyLine(const LinkConditions& conditions, std::uint64_t seed) : conditions_(conditions), rng_(seed) {}

  /// The fate of one packet: no, one or two arrivals.
  struct Fate {
    std::uint64_t number = 0;  ///< of the packet, counted from 1
    int copies = 0;
    std::array<Time, 2> arrivals{};
  };
  /// A packet of `size` bytes is sent.
  Fate send(Time now, std::size_t size);

  /// A copy has reached a receiver, or there was none for it.
  void delivered(std::uint64_t number);
  void dropped() { ++counters_.dropped; }

  /// From now on; packets under way are not affected.
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
