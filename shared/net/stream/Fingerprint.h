// The name of a server's key, as people copy it: SHA-256 of the SubjectPublicKeyInfo (as in RFC 7469 2.4), 64
// hexadecimal digits. Of the key, not of the certificate, so that a renewed certificate keeps it.
// Hexadecimal, because it stands in command lines: no quoting, no leading dash, one double click selects it.
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
  /// Of the key in a certificate.
  static Fingerprint of(const x509_st& certificate);
  /// 64 hexadecimal digits of either case, and nothing else.
  static std::optional<Fingerprint> parse(std::string_view text);
  /// 64 lower-case hexadecimal digits.
  std::string text() const;
  const std::array<std::uint8_t, 32>& bytes() const { return bytes_; }

  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;

 private:
  Fingerprint() = default;
  std::array<std::uint8_t, 32> bytes_{};
};

/// The short name of a server's key, as it stands in a link: the first 128 bits of its fingerprint in base32
/// (RFC 4648 6, without padding, lower case), 26 characters.
///
/// 128 bits are enough for a key that nobody can make on purpose to have this name. Base32, because it is
/// typed and read out: either case means the same, and 0, 1, 8 and 9, which look like letters, do not occur.
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
  /// 26 characters a…z, A…Z, 2…7 of which the last bits are 0, and nothing else: each key has one text, but
  /// for its case.
  static std::optional<ShortKey> parse(std::string_view text);
  /// 26 lower-case characters.
  std::string text() const;
  const Bytes& bytes() const { return bytes_; }

  friend bool operator==(const ShortKey&, const ShortKey&) = default;

 private:
  ShortKey() = default;
  Bytes bytes_{};
};

/// What a TLS handshake proved about the server at the other end. Whether that is enough is the client's
/// decision.
struct PeerFacts {
  Fingerprint key;              ///< of the key that the server proved to hold
  bool chain_verifies = false;  ///< its certificate is for this host name and from an authority trusted here
  std::string chain_problem;    ///< why not, in OpenSSL's words ("self-signed certificate"); empty if it is
};

}  // namespace naiad
