// Counters of sent and received messages of a session.
#pragma once

#include <cstdint>

namespace naiad {

/// Byte counts are sizes of frame payloads, plus two header bytes per frame; datagrams count without headers.
struct SessionCounters {
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t stale_snapshots = 0;  ///< dropped: they refer to state that newer snapshots replaced
  std::uint64_t inputs = 0;
  std::uint64_t inputs_dropped = 0;  ///< not sent: too many, or the stream is stuck
  std::uint64_t chat_lines = 0;
  std::uint64_t sounds = 0;
  std::uint64_t chat_dropped = 0;     ///< not sent: too many unacknowledged frames
  std::uint64_t repeated_frames = 0;  ///< reliable frames received before: ignored
  std::uint64_t datagrams_in = 0;     ///< snapshots received by datagram
  std::uint64_t resets = 0;           ///< number of worlds after the first one
  std::uint64_t bad_messages = 0;
};

}  // namespace naiad
