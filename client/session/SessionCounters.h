// What a session has sent and received so far.
#pragma once

#include <cstdint>

namespace naiad {

/// Bytes are frame payloads plus two bytes of header each.
struct SessionCounters {
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t stale_snapshots = 0;  ///< dropped: they named what newer ones had replaced
  std::uint64_t inputs = 0;
  std::uint64_t inputs_dropped = 0;  ///< not sent: too many, or the stream is stuck
  std::uint64_t chat_lines = 0;
  std::uint64_t sounds = 0;
  std::uint64_t chat_dropped = 0;     ///< not sent: too many unacknowledged frames
  std::uint64_t repeated_frames = 0;  ///< reliable frames received before: ignored
  std::uint64_t datagrams_in = 0;     ///< with a snapshot; their bytes are in bytes_in, headers not counted
  std::uint64_t resets = 0;           ///< worlds sent again from the start
  std::uint64_t bad_messages = 0;
};

}  // namespace naiad
