// The host names by which browsers may reach the gateway, and the origins that may open a WebSocket.
//
// A malicious page can make its own name resolve to 127.0.0.1 (DNS rebinding) and so reach servers on
// loopback; the browser then sends that name as Host (RFC 9110 7.2). And every page may open a WebSocket to
// every host; the browser then sends the page's Origin (RFC 6455 10.2). Both headers are checked against
// lists.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

/// An origin: http://HOST[:PORT] or https://HOST[:PORT].
struct WebOrigin {
  bool is_secure = false;
  std::string host;  ///< lower case; IPv6 in brackets, as in a URL
  std::uint16_t port = 0;

  /// Parses an origin; one '/' may follow it. Returns nullopt if invalid.
  static std::optional<WebOrigin> parse(std::string_view text);
  /// Returns the origin as browsers write it: without the scheme's default port.
  std::string text() const;
  /// Returns the value of the Host header: HOST[:PORT].
  std::string hostText() const;
};

class AllowedOrigins {
 public:
  void add(const WebOrigin& origin);
  bool isEmpty() const { return m_hosts.empty(); }

  /// True if the Host header is allowed. Ignores case; the scheme's default port may be omitted.
  bool allowsHost(std::string_view host) const;
  /// True if the Origin header is allowed.
  bool allowsOrigin(std::string_view origin) const;

 private:
  std::vector<std::string> m_hosts;
  std::vector<std::string> m_origins;
};

}  // namespace naiad
