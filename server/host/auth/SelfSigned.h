// Makes keys and self-signed certificates.
#pragma once

#include <chrono>
#include <string>

namespace naiad {

/// A new ECDSA P-256 key (RFC 5480), PEM (PKCS #8). Throws TlsError.
std::string makeKeyPem();

/// A certificate for that key, signed by itself: X.509 v3, common name "naiad", valid from the day before
/// `now` (clocks differ) until 9999-12-31 ("no end", RFC 5280 4.1.2.5), for players pin the key. PEM. Throws
/// TlsError.
std::string makeCertificatePem(const std::string& key_pem, std::chrono::system_clock::time_point now);

}  // namespace naiad
