// The key by which players know a server, and its certificate.
//
// Two files: key.pem (0600) and certificate.pem. The key is made once and never replaced; a certificate that
// is missing is made for it, self-signed. The fingerprint is of the key, so it stays as long as key.pem does.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

// Makes keys and self-signed certificates.

/// A new ECDSA P-256 key (RFC 5480), PEM (PKCS #8). Throws TlsError.
std::string makeKeyPem();

/// A certificate for that key, signed by itself: X.509 v3, common name "naiad", valid from the day before
/// `now` (clocks differ) until 9999-12-31 ("no end", RFC 5280 4.1.2.5), for players pin the key. PEM. Throws
/// TlsError.
std::string makeCertificatePem(const std::string& key_pem, std::chrono::system_clock::time_point now);

class ServerIdentity {
 public:
  /// $XDG_CONFIG_HOME/naiad, or ~/.config/naiad. Throws TlsError if the environment names neither.
  static std::filesystem::path defaultDirectory();

  /// Load from `directory` (made if missing, 0700), making first what is not there: an ECDSA P-256 key, and a
  /// certificate that is valid from the day before `now` on, without end. Two servers that start there at
  /// once get the same key. Throws TlsError, with a sentence that says what to do; also if every user can
  /// write in the directory.
  static ServerIdentity loadOrMake(const std::filesystem::path& directory,
                                   std::chrono::system_clock::time_point now);
  /// Load files from elsewhere, e.g. Let's Encrypt's fullchain.pem and privkey.pem. Throws TlsError, also if
  /// the key is readable by others than its owner.
  static ServerIdentity load(const std::filesystem::path& certificate, const std::filesystem::path& key);

  /// What players compare.
  const Fingerprint& fingerprint() const { return fingerprint_; }
  /// What the host should know of the directory: who else can write in it. Empty if nobody can.
  const std::string& warning() const { return warning_; }
  /// For TcpListener.
  const std::shared_ptr<const TlsContext>& tls() const { return tls_; }

 private:
  ServerIdentity(const std::string& certificate_pem, const std::string& key_pem);

  std::shared_ptr<const TlsContext> tls_;
  Fingerprint fingerprint_;
  std::string warning_;
};

}  // namespace naiad
