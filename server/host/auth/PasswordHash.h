// A server's password as stored in memory: an Argon2id hash (RFC 9106) in its usual text form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace naiad {

/// Thrown if there is not enough memory for a hash, or a hash is invalid. what() is one sentence for people.
class PasswordError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Maximum length of a password in bytes. Longer ones match no hash.
inline constexpr std::size_t kMaxPassword = 128;

class PasswordHash {
 public:
  /// The cost of a guess. The defaults take about 0.1 s and 64 MiB per guess.
  struct Cost {
    std::uint32_t memory_kib = 64 * 1024;
    std::uint32_t passes = 3;
  };

  /// Hashes a password of 1 … kMaxPassword bytes with a fresh salt. As slow as a guess. Throws PasswordError.
  static PasswordHash of(std::string_view password, Cost cost);
  static PasswordHash of(std::string_view password) { return of(password, Cost{}); }
  /// Parses the text of an option or file: a hash ("$argon2id$…"), or the password itself. Ignores line
  /// breaks at the end. Throws PasswordError.
  static PasswordHash fromText(std::string_view text);

  /// True if this is the password; takes equally long if not. Throws PasswordError if memory is short. Any
  /// thread.
  bool matches(std::string_view password) const;
  /// The hash as text: "$argon2id$v=19$m=65536,t=3,p=1$…"
  const std::string& text() const { return text_; }

 private:
  explicit PasswordHash(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

}  // namespace naiad
