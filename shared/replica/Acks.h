// Which snapshots arrived: the receiver's half of acknowledgement by number and mask.
//
// Snapshot numbers count up from 1 and wrap around after 2^32 − 1; "newer" is meant in serial-number
// arithmetic (RFC 1982).
#pragma once

#include <cstdint>

namespace naiad {

/// Is `a` newer than `b`?
constexpr bool isNewer(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a - b) > 0;
}

/// The newest number received and the 64 before it (bit i: newest − 1 − i).
struct AckWindow {
  std::uint32_t newest = 0;
  std::uint64_t mask = 0;

  /// Note that `number` arrived; older than the window is ignored.
  void note(std::uint32_t number);
  /// Is `number` known to have arrived?
  bool has(std::uint32_t number) const;
};

}  // namespace naiad
