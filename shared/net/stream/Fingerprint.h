// The name of a server's key, as people copy it: SHA-256 of the SubjectPublicKeyInfo (as in RFC 7469 2.4), 64
// hexadecimal digits. Of the key, not of the certificate, so that a renewed certificate keeps it.
// Hexadecimal, because it stands in command lines: no quoting, no leading dash, one double click selects it.
#pragma once

#include <array>
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

}  // namespace naiad
