// A server's password, as it is kept in memory: an Argon2id hash (RFC 9106) in its usual text form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace naiad {

/// No memory for a hash, or a text that is none. what() is one sentence for people.
class PasswordError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Longer ones match nothing, in bytes.
inline constexpr std::size_t kMaxPassword = 128;

class PasswordHash {
 public:
  /// What guessing costs. The defaults take about 0.1 s and 64 MiB for each guess.
  struct Cost {
    std::uint32_t memory_kib = 64 * 1024;
    std::uint32_t passes = 3;
  };

  /// Of a password (1 … kMaxPassword bytes), with a fresh salt. Takes the time of a guess. Throws
  /// PasswordError.
  static PasswordHash of(std::string_view password, Cost cost);
  static PasswordHash of(std::string_view password) { return of(password, Cost{}); }
  /// What a host wrote into an option or a file: a hash ("$argon2id$…"), or the password itself; line ends at
  /// its end are ignored. Throws PasswordError.
  static PasswordHash fromText(std::string_view text);

  /// Takes as long for a wrong password as for the right one. Throws PasswordError without memory. Any
  /// thread.
  bool matches(std::string_view password) const;
  /// "$argon2id$v=19$m=65536,t=3,p=1$…"
  const std::string& text() const { return text_; }

 private:
  explicit PasswordHash(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

}  // namespace naiad
