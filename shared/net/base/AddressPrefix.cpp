#include "shared/net/base/AddressPrefix.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <system_error>

#include "shared/net/base/SafeText.h"

namespace naiad {

AddressPrefix::AddressPrefix(const Bytes& address) {
  const bool mapped = std::equal(kMappedIPv4.begin(), kMappedIPv4.end(), address.begin());
  std::memcpy(&bits_, address.data() + (mapped ? sizeof bits_ : 0), sizeof bits_);
}

AddressPrefix AddressPrefix::of(const asio::ip::address& address) {
  const auto six =
      address.is_v6() ? address.to_v6() : asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4());
  return AddressPrefix(six.to_bytes());
}

std::optional<AddressPrefix> AddressPrefix::ofEndpoint(std::string_view text) {
  const auto endpoint = NumericEndpoint::parse(text);
  return endpoint ? std::optional(of(endpoint->address)) : std::nullopt;
}

AddressPrefix AddressPrefix::wide() const {
  return without(1);
}

AddressPrefix AddressPrefix::widest() const {
  return without(isIPv4() ? 1 : 2);
}

bool AddressPrefix::isIPv4() const {
  return std::memcmp(&bits_, kMappedIPv4.data() + sizeof bits_, kMappedIPv4.size() - sizeof bits_) == 0;
}

// Returns the prefix with the last `bytes` of its 8 bytes cleared.
AddressPrefix AddressPrefix::without(std::size_t bytes) const {
  AddressPrefix wider = *this;
  std::memset(reinterpret_cast<char*>(&wider.bits_) + sizeof bits_ - bytes, 0, bytes);
  return wider;
}

asio::ip::address unmapped(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
  }
  return address;
}

std::optional<NumericEndpoint> NumericEndpoint::parse(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = readNumber<std::uint16_t>(text.substr(colon + 1), 0, 65'535);
  std::string_view host = text.substr(0, colon);
  const bool in_brackets = host.size() >= 2 && host.starts_with('[') && host.ends_with(']');
  if (in_brackets) host = host.substr(1, host.size() - 2);
  std::error_code error;
  const auto address = asio::ip::make_address(std::string(host), error);
  if (!port || error || address.is_v6() != in_brackets) return std::nullopt;
  return NumericEndpoint{address, *port};
}

}  // namespace naiad
