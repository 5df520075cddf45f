// By which names browsers may reach the gateway, and whose pages may open a WebSocket.
//
// A page of a stranger can have its own name resolved to 127.0.0.1 (DNS rebinding) and so reach what listens
// on loopback; the browser then sends that name as Host (RFC 9110 7.2). And every page may open a WebSocket
// to every host; the browser then says whose page it is (Origin, RFC 6455 10.2). Both are held against a
// list.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

/// http://HOST[:PORT] or https://HOST[:PORT], without anything behind it but one '/'.
struct WebOrigin {
  bool is_secure = false;
  std::string host;  ///< lower case; IPv6 in brackets, as in a URL
  std::uint16_t port = 0;

  static std::optional<WebOrigin> parse(std::string_view text);
  /// As browsers write it: without the scheme's own port.
  std::string text() const;
  /// The part of it that is in Host.
  std::string hostText() const;
};

class AllowedNames {
 public:
  void add(const WebOrigin& origin);
  bool isEmpty() const { return m_hosts.empty(); }

  /// A Host header, in any case, with or without the scheme's own port.
  bool allowsHost(std::string_view host) const;
  /// An Origin header.
  bool allowsOrigin(std::string_view origin) const;

 private:
  std::vector<std::string> m_hosts;
  std::vector<std::string> m_origins;
};

}  // namespace naiad
