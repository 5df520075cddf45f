// The header of every sealed datagram.
//
//   to server   [kind 4 bits | epoch 4 bits] [connection id, 8 bytes] [sequence, 2 bytes] ciphertext tag
//   to client   [kind 4 bits | epoch 4 bits]                          [sequence, 2 bytes] ciphertext tag
//
// The kind is the upper half of the first byte, the lowest four bits of the epoch the lower half. Numbers are
// little-endian. The kind also gives the direction, so a packet reflected to its sender is refused before any
// key is used. Packets to a client need no id because it has one session.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace naiad {

/// The largest datagram that is sent or accepted, in bytes of UDP payload.
inline constexpr std::size_t kMaxDatagram = 1200;
/// The authentication tag at the end of every sealed datagram, in bytes.
inline constexpr std::size_t kSealTagSize = 16;

/// Identifies a session on the wire: random, chosen by the server, not secret, never changed.
struct ConnectionId {
  std::uint64_t value = 0;
  friend auto operator<=>(const ConnectionId&, const ConnectionId&) = default;
};

/// Counts the keys of a session, from 0. Only its low four bits are on the wire.
using Epoch = std::uint32_t;
inline constexpr unsigned kEpochBits = 4;
inline constexpr Epoch kEpochMask = (1u << kEpochBits) - 1;

enum class SealDirection : std::uint8_t { kClientToServer, kServerToClient };

/// Return the size of the header, and of the shortest valid packet: header, one byte of flags, tag. In bytes.
constexpr std::size_t sealedHeaderSize(SealDirection direction) {
  return direction == SealDirection::kClientToServer ? 11 : 3;
}
constexpr std::size_t smallestSealedPacket(SealDirection direction) {
  return sealedHeaderSize(direction) + 1 + kSealTagSize;
}

struct SealedHeader {
  Epoch epoch_bits = 0;        ///< the low bits of the epoch
  ConnectionId id;             ///< only in packets from the client
  std::uint16_t sequence = 0;  ///< the low bits of the sequence number
};

/// The reason why bytes are not a sealed datagram, in the order in which the reasons are tested.
enum class HeaderFault : std::uint8_t { kNone, kTooShort, kTooLong, kKind };

/// Reads the header of a packet that travels in `direction`.
HeaderFault readSealedHeader(SealDirection direction, std::string_view packet, SealedHeader& header);

/// Writes a header without its sequence number, which the Sealer adds. Returns the number of bytes written.
std::size_t writeSealedPrefix(SealDirection direction, Epoch epoch, ConnectionId id, char* out);

}  // namespace naiad

template <>
struct std::hash<naiad::ConnectionId> {
  std::size_t operator()(const naiad::ConnectionId& id) const noexcept {
    return static_cast<std::size_t>(id.value);  // already random
  }
};
