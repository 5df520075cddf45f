// Counters of a world's handlers. In every engine, handling an event only changes these. Engines that send
// equal events in equal order have equal checksums at the end.
#pragma once

#include <cstdint>

namespace bench {

struct Tally {
  std::uint64_t tick = 0;      ///< number of the present tick, from 1
  std::uint64_t events = 0;    ///< collision events received
  std::uint64_t blocked = 0;   ///< moves blocked by a HARD object
  std::uint64_t checksum = 0;  ///< checksum of the receivers' ids, in the order of events

  void event(std::uint64_t receiver) {
    ++events;
    checksum = checksum * 0x9e3779b97f4a7c15u + receiver;
  }
};

}  // namespace bench
