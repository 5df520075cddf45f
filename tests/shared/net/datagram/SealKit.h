// What the tests of sealed datagrams share: a TLS 1.3 exporter without the TLS.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "shared/net/datagram/DatagramKeys.h"

namespace naiad::test {

/// RFC 8446, 7.5, with SHA-256, for a connection whose exporter_master_secret is `secret`.
KeyExporter tlsExporter(std::string secret);
/// The one that the known answers were made with: the bytes 0, 1, … 31.
KeyExporter knownExporter();

inline constexpr ConnectionId kKnownId{0x0123456789abcdef};

/// Keys of an epoch of a session with knownExporter().
DatagramKeys knownKeys(AeadId aead, ConnectionId id = kKnownId, Epoch epoch = 0x13);

inline constexpr AeadId kBothAeads[] = {AeadId::kAes128Gcm, AeadId::kChaCha20Poly1305};

}  // namespace naiad::test
