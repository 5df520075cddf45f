// Limits of the sizes and counts of snapshots and records, enforced by both ends. PROTOCOL.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

/// Largest snapshot in bytes: on the stream (with space for the message around it); in a datagram.
inline constexpr std::size_t kMaxSnapshot = std::size_t{15} * 1024;
inline constexpr std::size_t kMaxDatagramSnapshot = 1150;

/// Slots of the replica. A server with more Objects in a world replicates the first ones and reports it.
inline constexpr std::uint32_t kMaxSlots = 1u << 20;
/// Most characters of an appearance, and most bytes of its encoding (so that a birth fits a snapshot).
inline constexpr std::size_t kMaxGlyphs = 8192;
inline constexpr std::size_t kMaxLookBytes = std::size_t{14} * 1024;
/// Most texts shown to a single player.
inline constexpr std::uint32_t kMaxTexts = 16;

/// Size of the view that a server grants, in cells.
inline constexpr int kMinViewWidth = 20;
inline constexpr int kMinViewHeight = 10;
inline constexpr int kMaxViewWidth = 400;
inline constexpr int kMaxViewHeight = 150;

}  // namespace naiad
