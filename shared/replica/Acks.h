// The set of received snapshots, acknowledged by number and mask.
//
// Snapshot numbers count from 1 and wrap after 2^32 − 1; "newer" follows serial-number arithmetic (RFC 1982).
#pragma once

#include <cstdint>

namespace naiad {

/// True if `a` is newer than `b`.
constexpr bool isNewer(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a - b) > 0;
}

/// Returns the number with these 16 low bits that is nearest to `near`: correct if it is less than 2^15 away.
constexpr std::uint32_t expandSerial(std::uint64_t low, std::uint32_t near) {
  const auto apart =
      static_cast<std::int16_t>(static_cast<std::uint16_t>(low) - static_cast<std::uint16_t>(near));
  return near + static_cast<std::uint32_t>(std::int32_t{apart});
}

/// The newest number received and the 64 before it (bit i: newest − 1 − i).
struct AckWindow {
  std::uint32_t newest = 0;
  std::uint64_t mask = 0;

  /// Records that `number` arrived; ignores a number older than the window.
  void addReceived(std::uint32_t number);
  /// True if `number` is known to have arrived.
  bool has(std::uint32_t number) const;
};

}  // namespace naiad
