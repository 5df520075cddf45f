#include "client/trust/GatewayAddress.h"

#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::string_view kPlain = "http://";
constexpr std::string_view kEncrypted = "https://";

}  // namespace

bool GatewayAddress::isMeant(std::string_view text) {
  return text.starts_with(kPlain) || text.starts_with(kEncrypted);
}

std::optional<GatewayAddress> GatewayAddress::parse(const std::string& text) {
  if (!isMeant(text)) return std::nullopt;
  GatewayAddress address;
  address.encrypted = text.starts_with(kEncrypted);
  const std::string rest = text.substr((address.encrypted ? kEncrypted : kPlain).size());
  const std::size_t end = rest.find_first_of("/#");
  if (end != std::string::npos && rest[end] == '/' && end + 1 < rest.size() && rest[end + 1] != '#')
    return std::nullopt;
  const auto where = LinkHost::parse(rest.substr(0, end), address.usualPort());
  if (!where) return std::nullopt;
  address.host = where->host;
  address.port = where->port;
  return address;
}

std::string GatewayAddress::hostText() const {
  const std::string name = host.find(':') != std::string::npos ? "[" + host + "]" : host;
  return port == usualPort() ? name : name + ":" + std::to_string(port);
}

}  // namespace naiad
