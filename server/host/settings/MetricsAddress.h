// Where metrics are given out: --metrics ADDR:PORT, and by which names the server may be asked there.
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
  /// It is loopback, or of a network that no router of the internet leads to (RFC 1918, 3927, 4193, 4291).
  bool is_private = false;

  /// "127.0.0.1:9100", "[::1]:9100"; port 0 takes any free one. Nothing if it is none.
  static std::optional<MetricsAddress> parse(std::string_view text);
  /// As in a URL: IPv6 in brackets.
  std::string hostText() const {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
  }
};

/// The names in the Host header of a request that may have an answer.
///
/// A page of a stranger can have its own name resolved to 127.0.0.1 (DNS rebinding) and so reach what listens
/// there; the browser then sends that name. A number as Host is no stranger's name.
class MetricsHosts {
 public:
  /// `names`: beside "localhost" and numbers, with commas between. Nothing if one of them is no name.
  static std::optional<MetricsHosts> parse(std::string_view names);
  /// A Host header, in any case, with any port or none (a container's may be forwarded from another).
  bool allows(std::string_view host) const;

 private:
  std::vector<std::string> m_names;  ///< lower case
};

}  // namespace naiad
