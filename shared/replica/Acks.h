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

/// The number with these 16 low bits that is nearest to `near`: right as long as they are less than 2^15
/// apart.
constexpr std::uint32_t restored(std::uint64_t low, std::uint32_t near) {
  const auto apart =
      static_cast<std::int16_t>(static_cast<std::uint16_t>(low) - static_cast<std::uint16_t>(near));
  return near + static_cast<std::uint32_t>(std::int32_t{apart});
}

/// The newest number received and the 64 before it (bit i: newest − 1 − i).
struct AckWindow {
  std::uint32_t newest = 0;
  std::uint64_t mask = 0;

  /// `number` arrived; one older than the window is ignored.
  void addReceived(std::uint32_t number);
  /// Is `number` known to have arrived?
  bool has(std::uint32_t number) const;
};

}  // namespace naiad
