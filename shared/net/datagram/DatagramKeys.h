// The keys of one epoch of a session's datagrams, derived from the session's TLS connection.
//
// Both ends call deriveDatagramKeys() with the exporter of one TLS 1.3 connection (RFC 8446, 7.5; RFC 5705)
// and get equal keys without sending anything, like NTS (RFC 8915) and DTLS-SRTP (RFC 5764). An end may use
// the exporter after its handshake is complete.
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

/// The ciphers that can seal datagrams. The numbers are fixed, because they are part of the wire format.
enum class AeadId : std::uint8_t { kAes128Gcm = 1, kChaCha20Poly1305 = 2 };

/// Returns the cipher; nullopt for an unknown number.
std::optional<AeadId> aeadFromWire(std::uint32_t number);
/// Returns the key size in bytes: 16 or 32.
std::size_t aeadKeySize(AeadId aead);
inline constexpr std::size_t kAeadIvSize = 12;

/// Key and IV of one direction. The destructor overwrites them.
struct SealKey {
  SealKey() = default;
  SealKey(const SealKey&) = default;
  SealKey& operator=(const SealKey&) = default;
  ~SealKey();

  AeadId aead = AeadId::kAes128Gcm;
  std::array<unsigned char, 32> key{};  ///< only the first aeadKeySize(aead) bytes are used
  std::array<unsigned char, kAeadIvSize> iv{};
};

struct DatagramKeys {
  SealKey client;  ///< seals packets from the client to the server
  SealKey server;  ///< seals packets from the server to the client
};

/// A TLS exporter: returns `bytes` bytes of keying material for label and context; empty if unavailable.
using KeyExporter =
    std::function<std::string(std::string_view label, std::string_view context, std::size_t bytes)>;

inline constexpr std::string_view kDatagramKeyLabel = "EXPERIMENTAL-naiad-datagram";

/// Thrown if the exporter returns a wrong number of bytes.
class KeyExportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the exporter's context, 17 bytes, little-endian: protocol version (4), AEAD id (1), connection id
/// (8), epoch (4). A change of any of them changes the keys.
std::string datagramKeyContext(AeadId aead, ConnectionId id, Epoch epoch);

/// Derives client key, client IV, server key and server IV, in this order. Throws KeyExportError.
DatagramKeys deriveDatagramKeys(const KeyExporter& exporter, AeadId aead, ConnectionId id, Epoch epoch);

}  // namespace naiad
