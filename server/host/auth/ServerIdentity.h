// The key that identifies a server to players, and its certificate.
//
// Two files: key.pem (0600) and certificate.pem. The key is made once and never replaced. A missing
// certificate is made for it, self-signed. The fingerprint is the key's, so a new certificate keeps it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

/// Returns a new ECDSA P-256 key (RFC 5480) as PEM (PKCS #8). Throws TlsError.
std::string makeKeyPem();

/// Returns a self-signed certificate for that key as PEM: X.509 v3, common name "naiad". It is valid from the
/// day before `now` (clocks differ) until 9999-12-31 ("no end", RFC 5280 4.1.2.5), because players pin the
/// key. Throws TlsError.
std::string makeCertificatePem(const std::string& key_pem, std::chrono::system_clock::time_point now);

class ServerIdentity {
 public:
  /// Returns $XDG_CONFIG_HOME/naiad, or ~/.config/naiad. Throws TlsError if the environment has neither.
  static std::filesystem::path defaultDirectory();

  /// Loads key and certificate from `directory`. Makes what is missing: the directory (0700), an ECDSA P-256
  /// key, a certificate valid from the day before `now` without end. Two servers that start at once get the
  /// same key. Throws TlsError, whose text says what to do; also if every user can write to the directory.
  static ServerIdentity loadOrMake(const std::filesystem::path& directory,
                                   std::chrono::system_clock::time_point now);
  /// Loads a certificate and its key from these files, e.g. Let's Encrypt's fullchain.pem and privkey.pem.
  /// Throws TlsError, also if other users can read the key.
  static ServerIdentity load(const std::filesystem::path& certificate, const std::filesystem::path& key);

  /// The fingerprint that players compare.
  const Fingerprint& fingerprint() const { return fingerprint_; }
  /// A warning if another user or group can write to the directory; otherwise empty.
  const std::string& warning() const { return warning_; }
  /// The TLS settings for TcpListener.
  const std::shared_ptr<const TlsContext>& tls() const { return tls_; }

 private:
  ServerIdentity(const std::string& certificate_pem, const std::string& key_pem);

  std::shared_ptr<const TlsContext> tls_;
  Fingerprint fingerprint_;
  std::string warning_;
};

}  // namespace naiad
