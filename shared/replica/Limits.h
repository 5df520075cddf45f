// Limits of the sizes and counts of snapshots and records, enforced by both ends. PROTOCOL.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

/// Largest snapshot in bytes: on the stream (with space for the message around it); in a datagram.
inline constexpr std::size_t kMaxSnapshot = std::size_t{15} * 1024;
inline constexpr std::size_t kMaxDatagramSnapshot = 1150;

/// Number of slots that are replicated; the last one is for drawings without an Object (kFreeDrawSlot). If a
/// world has more Objects, the server ignores the others and counts them.
inline constexpr std::uint32_t kMaxSlots = 1u << 20;
/// Maximum glyphs of a sequence, and maximum bytes of its encoding (so that a birth fits a snapshot).
inline constexpr std::size_t kMaxGlyphs = 8192;
inline constexpr std::size_t kMaxLookBytes = std::size_t{14} * 1024;
/// Maximum number of texts shown to a single player.
inline constexpr std::uint32_t kMaxTexts = 16;

/// Least and largest size of the view that a server grants, in cells.
inline constexpr int kMinViewWidth = 20;
inline constexpr int kMinViewHeight = 10;
inline constexpr int kMaxViewWidth = 400;
inline constexpr int kMaxViewHeight = 150;

}  // namespace naiad
