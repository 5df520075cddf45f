// HOST[:PORT] as people type it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "shared/net/base/Limits.h"

namespace naiad {

struct ServerAddress {
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = kDefaultPort;

  /// "localhost", "localhost:9876", "127.0.0.1", "::1", "[::1]:9876". Nothing if it is none of these or the
  /// port is not in 1 … 65535.
  static std::optional<ServerAddress> parse(const std::string& text);
  /// "localhost:9876", "[::1]:9876".
  std::string text() const;
  /// The same in one spelling for each server: lower case, no dot at the end of the host.
  std::string canonicalText() const;

  friend bool operator==(const ServerAddress&, const ServerAddress&) = default;
};

}  // namespace naiad
