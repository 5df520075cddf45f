// The keys of one epoch of a session's datagrams, taken from the TLS session beside them.
//
// Both ends call deriveDatagramKeys() with the exporter of the same TLS 1.3 connection (RFC 8446, 7.5; RFC
// 5705) and get the same keys without another byte on the wire, as NTS (RFC 8915) and DTLS-SRTP (RFC 5764)
// do. The exporter may be used once the handshake is complete on that side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "shared/net/datagram/SealedHeader.h"

namespace naiad {

/// The ciphers that datagrams can be sealed with; the numbers are on the wire.
enum class AeadId : std::uint8_t { kAes128Gcm = 1, kChaCha20Poly1305 = 2 };

/// Nothing for a number that names no cipher.
std::optional<AeadId> aeadFromWire(std::uint32_t number);
/// Key bytes: 16 or 32.
std::size_t aeadKeySize(AeadId aead);
inline constexpr std::size_t kAeadIvSize = 12;

/// Key and IV of one direction. Wiped when destroyed.
struct SealKey {
  SealKey() = default;
  SealKey(const SealKey&) = default;
  SealKey& operator=(const SealKey&) = default;
  ~SealKey();

  AeadId aead = AeadId::kAes128Gcm;
  std::array<unsigned char, 32> key{};  ///< the first aeadKeySize(aead) bytes
  std::array<unsigned char, kAeadIvSize> iv{};
};

struct DatagramKeys {
  SealKey client;  ///< seals client to server
  SealKey server;  ///< seals server to client
};

/// TLS exporter: `bytes` bytes of keying material for label and context; empty if it has none to give.
using KeyExporter =
    std::function<std::string(std::string_view label, std::string_view context, std::size_t bytes)>;

inline constexpr std::string_view kDatagramKeyLabel = "EXPERIMENTAL-naiad-datagram";

/// The exporter gave other than the bytes asked for.
class KeyExportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the exporter is given as context, 17 bytes, little-endian: protocol version (4), AEAD id (1),
/// connection id (8), epoch (4). So keys differ whenever one of them does.
std::string datagramKeyContext(AeadId aead, ConnectionId id, Epoch epoch);

/// The material is, in this order: client key, client IV, server key, server IV. Throws KeyExportError.
DatagramKeys deriveDatagramKeys(const KeyExporter& exporter, AeadId aead, ConnectionId id, Epoch epoch);

}  // namespace naiad
