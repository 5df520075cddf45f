#include "client/trust/ServerAddress.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::string_view kPlain = "http://";
constexpr std::string_view kEncrypted = "https://";

}  // namespace

bool GatewayAddress::looksLikeLink(std::string_view text) {
  return text.starts_with(kPlain) || text.starts_with(kEncrypted);
}

std::optional<GatewayAddress> GatewayAddress::parse(const std::string& text) {
  if (!looksLikeLink(text)) return std::nullopt;
  GatewayAddress address;
  address.encrypted = text.starts_with(kEncrypted);
  const std::string rest = text.substr((address.encrypted ? kEncrypted : kPlain).size());
  const std::size_t end = rest.find_first_of("/#");
  if (end != std::string::npos && rest[end] == '/' && end + 1 < rest.size() && rest[end + 1] != '#')
    return std::nullopt;
  const auto where = LinkHost::parse(rest.substr(0, end), address.defaultPort());
  if (!where) return std::nullopt;
  address.host = where->host;
  address.port = where->port;
  return address;
}

std::string GatewayAddress::hostText() const {
  return LinkHost{host, port}.text(defaultPort());
}

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
  const bool good_host =
      !address.host.empty() && address.host.size() <= 253 && !address.host.ends_with("..") &&
      std::none_of(address.host.begin(), address.host.end(),
                   [](unsigned char c) { return c <= ' ' || c == 0x7F || c == '[' || c == ']' || c == '/'; });
  if (!good_host) return std::nullopt;
  if (has_port) {
    const auto number = readNumber<std::uint16_t>(port, 1, 65'535);
    if (!number) return std::nullopt;
    address.port = *number;
  }
  return address;
}

std::string ServerAddress::text() const {
  return LinkHost{host, port}.text(0);
}

std::string ServerAddress::canonicalText() const {
  ServerAddress one{lowerCase(host), port};
  if (one.host.size() > 1 && one.host.back() == '.') one.host.pop_back();
  return one.text();
}

}  // namespace naiad
