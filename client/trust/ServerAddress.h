// Addresses as people type them: HOST[:PORT], and the URL of a gateway's page.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/base/Limits.h"

namespace naiad {

/// The address of a gateway's page: http[s]://HOST[:PORT]/[#…], as the gateway prints it.
struct GatewayAddress {
  bool encrypted = false;
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = 80;

  /// Does the text mean to be such an address? It begins with "http://" or "https://".
  static bool isMeant(std::string_view text);
  /// Nothing if it is no such address, or leads to another page of the host.
  static std::optional<GatewayAddress> parse(const std::string& text);
  /// "example.org:8080", "[::1]:8080": what stands in the header Host. Without the scheme's own port.
  std::string hostText() const;
  /// "https://example.org": what stands in the header Origin.
  std::string origin() const { return (encrypted ? "https://" : "http://") + hostText(); }

 private:
  std::uint16_t usualPort() const { return encrypted ? 443 : 80; }
};

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
