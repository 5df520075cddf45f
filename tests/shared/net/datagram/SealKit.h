// Helpers for tests of sealed datagrams: a TLS 1.3 exporter without TLS.
#pragma once

#include <string>

#include "shared/net/datagram/DatagramKeys.h"

namespace naiad::test {

/// Returns the exporter of RFC 8446, 7.5, with SHA-256 and this exporter_master_secret.
KeyExporter tlsExporter(std::string secret);
/// Returns the exporter of the known answers, whose secret is the bytes 0, 1, … 31.
KeyExporter knownExporter();

inline constexpr ConnectionId kKnownId{0x0123456789abcdef};

/// Returns the keys for this epoch of a session with knownExporter().
DatagramKeys knownKeys(AeadId aead, ConnectionId id = kKnownId, Epoch epoch = 0x13);

inline constexpr AeadId kBothAeads[] = {AeadId::kAes128Gcm, AeadId::kChaCha20Poly1305};

}  // namespace naiad::test
