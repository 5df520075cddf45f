// Counters of a soak run.
#pragma once

#include <cstdint>

namespace naiad::soak {

struct Tally {
  std::uint64_t snapshots = 0;  ///< snapshots applied by clients
  std::uint64_t compared = 0;   ///< number of compared pictures
  std::uint64_t compared_cells = 0;
  std::uint64_t wrong_cells = 0;
  std::uint64_t wrong_checksums = 0;  ///< found at all compared pictures; the product checks once a second
  std::uint64_t stuck = 0;            ///< times that a client received nothing although it should have
  std::uint64_t thrown_out = 0;       ///< unexpected goodbyes and refusals
  std::uint64_t lost_sessions = 0;    ///< clients that had to join as new players
  std::uint64_t joins = 0;
  std::uint64_t resumed = 0;
  std::uint64_t rebound = 0;
  std::uint64_t broken = 0;
  std::uint64_t killed = 0;
  std::uint64_t left = 0;
  std::uint64_t inputs = 0;          ///< keys and clicks that clients sent
  std::uint64_t inputs_lost = 0;     ///< inputs never received by the game although the session continued
  std::uint64_t inputs_wrong = 0;    ///< inputs received twice, out of order, or without being sent
  std::uint64_t inputs_dropped = 0;  ///< keys and clicks that the client refused to send
};

}  // namespace naiad::soak
