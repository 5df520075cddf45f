// The address of the metrics server (--metrics ADDR:PORT) and the host names accepted in requests to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

struct MetricsAddress {
  std::string address;  ///< numeric, IPv6 without brackets
  std::uint16_t port = 0;
  /// True for loopback and for networks that are not routed on the internet (RFC 1918, 3927, 4193, 4291).
  bool is_private = false;

  /// Parses "127.0.0.1:9100" or "[::1]:9100"; port 0 means any free one. Returns nullopt if invalid.
  static std::optional<MetricsAddress> parse(std::string_view text);
  /// Returns the address as in a URL: IPv6 in brackets.
  std::string hostText() const {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
  }
};

/// The host names that are accepted in the Host header of a request.
///
/// A malicious web page can make its own name resolve to 127.0.0.1 (DNS rebinding) and so reach servers
/// there; the browser then sends that name. Numeric hosts are safe and always accepted.
class MetricsHosts {
 public:
  /// Parses names separated by commas, accepted in addition to "localhost" and numeric addresses. Returns
  /// nullopt if one of them is invalid.
  static std::optional<MetricsHosts> parse(std::string_view names);
  /// True if the Host header is accepted. Ignores case and port, which may be a container's forwarded one.
  bool allows(std::string_view host) const;

 private:
  std::vector<std::string> m_names;  ///< lower case
};

}  // namespace naiad
