// The file format `.dfr`: a round, from the world's seed to its last tick (docs/dfr.md has every bit).
//
//   file    header | chunk | chunk | …
//   header  magic (8) | version (2) | flags (2) | CRC-32C of what follows (4) | uuid (16) | frame (8) | seed
//   (8)
//           | start (8) | 0 (8)
//   chunk   type (4) | size of the payload (4) | CRC-32C of type, size and payload (4) | payload
//
// Numbers have their lowest byte first. A file grows at its end alone, so one that was torn off is good up to
// its last whole chunk.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace naiad {

/// The first byte has its highest bit set and the last ones are line ends, as in PNG: a transfer as text
/// shows.
inline constexpr std::string_view kDfrMagic{
    "\x89"
    "DFR\r\n\x1a\n",
    8};
inline constexpr std::uint16_t kDfrVersion = 2;
inline constexpr std::size_t kDfrHeaderSize = 64;
inline constexpr std::size_t kDfrFlagsAt = 10;  ///< of the header's two bytes that change later
inline constexpr std::size_t kDfrChunkHead = 12;
/// Bytes of a payload, and of the turns that are packed in one.
inline constexpr std::size_t kMaxDfrPayload = std::size_t{1} << 20;

/// Bits of DfrHeader::flags. Unknown ones are ignored.
enum DfrFlag : std::uint16_t {
  kDfrStopped = 1 << 0,    ///< the journal stopped before the round did: nothing can go on from it
  kDfrInProcess = 1 << 1,  ///< the world was in the server's own process: its addresses and clocks were real
};

/// Which round it is.
struct DfrHeader {
  std::uint16_t flags = 0;                 ///< of DfrFlag
  std::array<std::uint8_t, 16> uuid = {};  ///< random: names the round
  std::uint64_t frame_nanos = 0;           ///< length of a tick
  std::uint64_t seed = 0;                  ///< of the world, and of what is repeatable of clocks and entropy
  std::uint64_t start_nanos = 0;           ///< the world's clock at its start, since 1970 in UTC
};

/// Four letters, the first lowest.
constexpr std::uint32_t dfrType(const char (&letters)[5]) {
  std::uint32_t type = 0;
  for (int i = 3; i >= 0; --i) type = type << 8 | static_cast<unsigned char>(letters[i]);
  return type;
}

/// What this version writes. Readers skip chunks of other types: VIEW, CHAT, MARK, INDX are set aside.
inline constexpr std::uint32_t kDfrMeta = dfrType("META");
inline constexpr std::uint32_t kDfrTurn = dfrType("TURN");
inline constexpr std::uint32_t kDfrDone = dfrType("DONE");

/// Facts by name. Names and values of META chunks; a later chunk adds to them.
using DfrFacts = std::map<std::string, std::string>;
inline constexpr std::size_t kMaxDfrFacts = 1024;
inline constexpr std::size_t kMaxDfrName = 300;
inline constexpr std::size_t kMaxDfrValue = 16'384;

/// A TURN chunk begins with the place of its first byte in the stream of records (2, the lowest 16 bits), and
/// a varint: how many bytes its records are, doubled, and how they are packed (DfrPacking). A small game's
/// chunk of a second is hardly 100 bytes.
inline constexpr std::size_t kDfrTurnPlace = 2;

/// How turns are packed in a TURN chunk.
enum DfrPacking : std::uint8_t {
  kDfrRaw = 0,
  kDfrModelled = 1,  ///< by a RecordPacker, which has packed all such chunks before
};

/// CRC-32C (Castagnoli), as iSCSI has it. `before`: of the bytes before these.
std::uint32_t crc32c(std::string_view bytes, std::uint32_t before = 0);

}  // namespace naiad
