#include "shared/net/base/AddressPrefix.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace naiad {

AddressPrefix AddressPrefix::of(const asio::ip::address& address) {
  AddressPrefix prefix;
  const asio::ip::address plain = unmapped(address);
  prefix.is_v6_ = plain.is_v6();
  if (prefix.is_v6_) {
    std::ranges::copy_n(plain.to_v6().to_bytes().begin(), 8, prefix.bytes_.begin());
  } else {
    std::ranges::copy(plain.to_v4().to_bytes(), prefix.bytes_.begin());
  }
  return prefix;
}

std::optional<AddressPrefix> AddressPrefix::ofEndpoint(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  std::error_code error;
  const auto address = asio::ip::make_address(std::string(host), error);
  if (error) return std::nullopt;
  return of(address);
}

asio::ip::address unmapped(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
  }
  return address;
}

}  // namespace naiad
