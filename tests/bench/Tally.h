// Counters of a world's handlers. The handlers of every engine do only this per event. Engines that send
// equal events in equal order end with equal checksums.
#pragma once

#include <cstdint>

namespace bench {

struct Tally {
  std::uint64_t tick = 0;      ///< present tick, from 1
  std::uint64_t events = 0;    ///< collision events received
  std::uint64_t blocked = 0;   ///< moves blocked by a HARD object
  std::uint64_t checksum = 0;  ///< over the receivers, in order of their events

  void event(std::uint64_t receiver) {
    ++events;
    checksum = checksum * 0x9e3779b97f4a7c15u + receiver;
  }
};

}  // namespace bench
