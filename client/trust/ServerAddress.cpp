#include "client/trust/ServerAddress.h"

#include <algorithm>
#include <charconv>

#include "client/trust/PinLines.h"

namespace naiad {

std::optional<ServerAddress> ServerAddress::parse(const std::string& text) {
  ServerAddress address;
  std::string port;
  bool has_port = false;
  if (!text.empty() && text[0] == '[') {
    const std::size_t end = text.find(']');
    if (end == std::string::npos) return std::nullopt;
    address.host = text.substr(1, end - 1);
    const std::string rest = text.substr(end + 1);
    if (!rest.empty() && rest[0] != ':') return std::nullopt;
    has_port = !rest.empty();
    if (has_port) port = rest.substr(1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    const std::size_t colon = text.find(':');
    address.host = text.substr(0, colon);
    port = text.substr(colon + 1);
    has_port = true;
  } else {
    address.host = text;  // without a port; more than one colon is a bare IPv6 address
  }
  const bool good_host = !address.host.empty() && address.host.size() <= 253 &&
                         std::none_of(address.host.begin(), address.host.end(), [](unsigned char c) {
                           return c <= ' ' || c == 0x7F || c == '[' || c == ']' || c == '/';
                         });
  if (!good_host) return std::nullopt;
  if (has_port) {
    unsigned value = 0;
    const char* last = port.data() + port.size();
    const auto [end, error] = std::from_chars(port.data(), last, value);
    if (error != std::errc{} || end != last || value == 0 || value > 65535) return std::nullopt;
    address.port = static_cast<std::uint16_t>(value);
  }
  return address;
}

std::string ServerAddress::text() const {
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? std::string("[") + host + "]" : host) + ":" + std::to_string(port);
}

std::string ServerAddress::canonicalText() const {
  ServerAddress one{lowerCase(host), port};
  if (one.host.size() > 1 && one.host.back() == '.') one.host.pop_back();
  return one.text();
}

}  // namespace naiad
