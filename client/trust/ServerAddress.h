// Addresses typed by people: HOST[:PORT], and the URL of a gateway's page.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/base/Limits.h"

namespace naiad {

/// Address of a gateway's page: http[s]://HOST[:PORT]/[#…], as the gateway prints it.
struct GatewayAddress {
  bool encrypted = false;
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = 80;

  /// True if the text begins with "http://" or "https://".
  static bool looksLikeLink(std::string_view text);
  /// Parses an address. Nullopt if it is invalid, or names another page of the host.
  static std::optional<GatewayAddress> parse(const std::string& text);
  /// Returns the value of the header Host: "example.org:8080", "[::1]"; without the scheme's default port.
  std::string hostText() const;
  /// Returns the value of the header Origin: "https://example.org".
  std::string origin() const { return (encrypted ? "https://" : "http://") + hostText(); }

 private:
  std::uint16_t defaultPort() const { return encrypted ? 443 : 80; }
};

struct ServerAddress {
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = kDefaultPort;

  /// Parses an address such as "localhost", "localhost:9876", "127.0.0.1", "::1", "[::1]:9876". Nullopt if
  /// the host is malformed or the port is not in 1 … 65535.
  static std::optional<ServerAddress> parse(const std::string& text);
  /// Returns the address as "localhost:9876", "[::1]:9876".
  std::string text() const;
  /// Like text(), in one spelling for each server: lower case, no dot at the end of the host.
  std::string canonicalText() const;

  friend bool operator==(const ServerAddress&, const ServerAddress&) = default;
};

}  // namespace naiad
