// What the handlers of a world have counted. Every engine's handlers do this and nothing more per event, and
// engines that send the same events in the same order end with the same checksum.
#pragma once

#include <cstdint>

namespace bench {

struct Tally {
  std::uint64_t tick = 0;      ///< the tick that runs, from 1
  std::uint64_t events = 0;    ///< collision events that were received
  std::uint64_t blocked = 0;   ///< moves that a HARD object refused
  std::uint64_t checksum = 0;  ///< of the receivers, in the order they were told

  void event(std::uint64_t receiver) {
    ++events;
    checksum = checksum * 0x9e3779b97f4a7c15u + receiver;
  }
};

}  // namespace bench
