// The short name of a server's key, as it stands in a link: the first 128 bits of its fingerprint
// (Fingerprint.h) in base32 (RFC 4648 6, without padding, lower case), 26 characters.
//
// 128 bits are enough for a key that nobody can make on purpose to have this name. Base32, because it is
// typed and read out: either case means the same, and 0, 1, 8 and 9, which look like letters, do not occur.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

class ShortKey {
 public:
  static constexpr std::size_t kBytes = 16;
  using Bytes = std::array<std::uint8_t, kBytes>;

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

}  // namespace naiad
