// The file format `.dfr`: a round, from the world's seed to its last tick. docs/dfr.md describes every bit.
//
//   file    header | chunk | chunk | …
//   header  magic (8) | version (2) | flags (2) | CRC-32C of what follows (4) | uuid (16) | frame (8)
//           | seed (8) | start (8) | 0 (8)
//   chunk   type (4) | size of the payload (4) | CRC-32C of type, size and payload (4) | payload
//
// Numbers are little-endian. Chunks are only appended, so a truncated file is valid up to its last whole one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace naiad {

/// The first byte has its highest bit set and the last ones are line ends, as in PNG: a transfer as text
/// damages it visibly.
inline constexpr std::string_view kDfrMagic{
    "\x89"
    "DFR\r\n\x1a\n",
    8};
inline constexpr std::uint16_t kDfrVersion = 2;
inline constexpr std::size_t kDfrHeaderSize = 64;
inline constexpr std::size_t kDfrFlagsAt = 10;  ///< offset of the flags, which are overwritten later
inline constexpr std::size_t kDfrChunkHead = 12;
/// Maximum size of a payload, and of its unpacked records, in bytes.
inline constexpr std::size_t kMaxDfrPayload = std::size_t{1} << 20;

/// Bits of DfrHeader::flags. Unknown ones are ignored.
enum DfrFlag : std::uint16_t {
  kDfrStopped = 1 << 0,    ///< the journal stopped before the round did, so the round cannot be resumed
  kDfrInProcess = 1 << 1,  ///< the world ran in the server's own process, with real addresses and clocks
};

/// Identifies the round.
struct DfrHeader {
  std::uint16_t flags = 0;                 ///< DfrFlag bits
  std::array<std::uint8_t, 16> uuid = {};  ///< random id of the round
  std::uint64_t frame_nanos = 0;           ///< length of a tick
  std::uint64_t seed = 0;                  ///< seeds the world, and its repeatable clocks and entropy
  std::uint64_t start_nanos = 0;           ///< the world's clock at its start, since 1970 in UTC
};

/// Returns the chunk type of four letters, the first in the lowest byte.
constexpr std::uint32_t dfrType(const char (&letters)[5]) {
  std::uint32_t type = 0;
  for (int i = 3; i >= 0; --i) type = type << 8 | static_cast<unsigned char>(letters[i]);
  return type;
}

/// Chunk types of this version. Readers skip others; VIEW, CHAT, MARK and INDX are reserved.
inline constexpr std::uint32_t kDfrMeta = dfrType("META");
inline constexpr std::uint32_t kDfrTurn = dfrType("TURN");
inline constexpr std::uint32_t kDfrDone = dfrType("DONE");

/// Names and values of META chunks. A later chunk adds to earlier ones.
using DfrFacts = std::map<std::string, std::string>;
/// Returns a fact; empty if it is missing.
inline std::string factOf(const DfrFacts& facts, const std::string& name) {
  const auto found = facts.find(name);
  return found != facts.end() ? found->second : std::string();
}
inline constexpr std::size_t kMaxDfrFacts = 1024;
inline constexpr std::size_t kMaxDfrName = 300;
inline constexpr std::size_t kMaxDfrValue = 16'384;

/// A TURN chunk begins with the position of its first byte in the record stream, modulo 65,536 (only 2 bytes,
/// because one second of a small game makes a chunk of barely 100 bytes), and a varint: twice the number of
/// unpacked bytes, plus the DfrPacking.
inline constexpr std::size_t kDfrTurnPositionSize = 2;

/// Packing of turns in a TURN chunk.
enum DfrPacking : std::uint8_t {
  kDfrRaw = 0,
  kDfrModelled = 1,  ///< packed by a RecordPacker that has packed all earlier such chunks
};

/// Returns the CRC-32C (Castagnoli, as in iSCSI) of `bytes`, after bytes whose checksum is `before`.
std::uint32_t crc32c(std::string_view bytes, std::uint32_t before = 0);

}  // namespace naiad
