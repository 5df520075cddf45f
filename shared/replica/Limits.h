// Sizes and counts of snapshots and of what they describe, to which both ends hold each other. PROTOCOL.md
// lists them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

/// Largest snapshot, in bytes: on the stream (leaves room for the message around it); in a datagram.
inline constexpr std::size_t kMaxSnapshot = std::size_t{15} * 1024;
inline constexpr std::size_t kMaxDatagramSnapshot = 1150;

/// Slots of the replica; a server with more Objects in one world replicates the first ones and says so.
inline constexpr std::uint32_t kMaxSlots = 1u << 20;
/// Characters of one appearance, and the bytes its encoding may take (so that a birth fits a snapshot).
inline constexpr std::size_t kMaxGlyphs = 8192;
inline constexpr std::size_t kMaxLookBytes = std::size_t{14} * 1024;
/// Player texts ("a text shown to one player only").
inline constexpr std::uint32_t kMaxTexts = 16;

/// The view a server grants, in cells.
inline constexpr int kMinViewWidth = 20;
inline constexpr int kMinViewHeight = 10;
inline constexpr int kMaxViewWidth = 400;
inline constexpr int kMaxViewHeight = 150;

}  // namespace naiad
