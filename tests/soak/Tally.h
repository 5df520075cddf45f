// What a soak counts.
#pragma once

#include <cstdint>

namespace naiad::soak {

struct Tally {
  std::uint64_t snapshots = 0;  ///< applied by clients
  std::uint64_t compared = 0;   ///< pictures
  std::uint64_t compared_cells = 0;
  std::uint64_t wrong_cells = 0;
  std::uint64_t wrong_checksums = 0;  ///< found here; the product looks once a second
  std::uint64_t stuck = 0;            ///< times a client that could have had news had none
  std::uint64_t thrown_out = 0;       ///< goodbyes and refusals that nobody asked for
  std::uint64_t lost_sessions = 0;    ///< clients that had to join as new players
  std::uint64_t joins = 0;
  std::uint64_t resumed = 0;
  std::uint64_t rebound = 0;
  std::uint64_t broken = 0;
  std::uint64_t killed = 0;
  std::uint64_t left = 0;
  std::uint64_t inputs = 0;          ///< sent
  std::uint64_t inputs_lost = 0;     ///< never heard, though the session went on
  std::uint64_t inputs_wrong = 0;    ///< heard twice, out of order, or never sent
  std::uint64_t inputs_dropped = 0;  ///< not sent: the client said so
};

}  // namespace naiad::soak
