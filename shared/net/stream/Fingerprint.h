// The fingerprint of a server's key, as people copy it: SHA-256 of the SubjectPublicKeyInfo (as in RFC 7469
// 2.4), 64 hexadecimal digits. It is made from the key, not the certificate, so that a renewed certificate
// keeps it. Hexadecimal suits command lines: no quoting, no leading dash, one double click selects it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

struct x509_st;

namespace naiad {

class Fingerprint {
 public:
  /// Returns the fingerprint of the key in a certificate.
  static Fingerprint of(const x509_st& certificate);
  /// Parses exactly 64 hexadecimal digits of either case; nullopt for other texts.
  static std::optional<Fingerprint> parse(std::string_view text);
  /// Returns 64 lower-case hexadecimal digits.
  std::string text() const;
  const std::array<std::uint8_t, 32>& bytes() const { return bytes_; }

  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;

 private:
  Fingerprint() = default;
  std::array<std::uint8_t, 32> bytes_{};
};

/// The short name of a server's key in a link: the first 128 bits of its fingerprint in base32 (RFC 4648 6,
/// without padding, lower case), 26 characters.
///
/// With 128 bits, making another key with this short name is infeasible. Base32 is easy to type and read out:
/// case does not matter, and it lacks 0, 1, 8 and 9, which look like letters.
class ShortKey {
 public:
  static constexpr std::size_t kBytes = 16;
  using Bytes = std::array<std::uint8_t, kBytes>;

  /// Returns the short name of a key, or the one with these bytes.
  static ShortKey of(const Fingerprint& key);
  static ShortKey ofBytes(const Bytes& bytes) {
    ShortKey key;
    key.bytes_ = bytes;
    return key;
  }
  /// Parses 26 characters a…z, A…Z, 2…7 whose two unused bits are 0; nullopt for other texts. Each key has
  /// one text, except for its case.
  static std::optional<ShortKey> parse(std::string_view text);
  /// Returns 26 lower-case characters.
  std::string text() const;
  const Bytes& bytes() const { return bytes_; }

  friend bool operator==(const ShortKey&, const ShortKey&) = default;

 private:
  ShortKey() = default;
  Bytes bytes_{};
};

/// The facts that a TLS handshake proved about the server. The client decides whether they are enough.
struct PeerIdentity {
  Fingerprint key;              ///< fingerprint of the key that the server proved to have
  bool chain_verifies = false;  ///< the certificate is valid for this host name and from an authority trusted
                                ///< here
  std::string chain_problem;    ///< OpenSSL's reason ("self-signed certificate"); empty if it verifies
};

}  // namespace naiad
