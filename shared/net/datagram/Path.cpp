#include "shared/net/datagram/Path.h"

#include <algorithm>
#include <asio/ip/address.hpp>

namespace naiad {
namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

}  // namespace

bool Endpoint::isIPv4() const {
  return std::equal(kMappedIPv4.begin(), kMappedIPv4.end(), address.begin());
}

bool Endpoint::isAny() const {
  const auto begin = address.begin() + (isIPv4() ? kMappedIPv4.size() : 0);
  return std::all_of(begin, address.end(), [](std::uint8_t byte) { return byte == 0; });
}

std::optional<Endpoint> makeEndpoint(std::string_view address, std::uint16_t port) {
  std::error_code error;
  const auto parsed = asio::ip::make_address(std::string(address), error);
  if (error) return std::nullopt;
  Endpoint endpoint;
  endpoint.port = port;
  if (parsed.is_v6()) {
    endpoint.address = parsed.to_v6().to_bytes();
    endpoint.scope = static_cast<std::uint32_t>(parsed.to_v6().scope_id());
    return endpoint;
  }
  const auto four = parsed.to_v4().to_bytes();
  std::copy(kMappedIPv4.begin(), kMappedIPv4.end(), endpoint.address.begin());
  std::copy(four.begin(), four.end(), endpoint.address.begin() + kMappedIPv4.size());
  return endpoint;
}

std::string toString(const Endpoint& endpoint) {
  const asio::ip::address_v6 six(endpoint.address, endpoint.scope);
  std::string text;
  if (endpoint.isIPv4()) {
    text = asio::ip::make_address_v4(asio::ip::v4_mapped, six).to_string();
  } else {
    text.append(1, '[').append(six.to_string()).append(1, ']');
  }
  return text.append(1, ':').append(std::to_string(endpoint.port));
}

std::string toString(const Path& path) {
  return toString(path.local) + " <- " + toString(path.remote);
}

std::optional<Endpoint> endpointFromText(std::string_view text) {
  const auto endpoint = NumericEndpoint::parse(text);
  return endpoint ? makeEndpoint(endpoint->address.to_string(), endpoint->port) : std::nullopt;
}

}  // namespace naiad

std::size_t std::hash<naiad::Endpoint>::operator()(const naiad::Endpoint& endpoint) const noexcept {
  using naiad::mix;
  const std::uint64_t rest = std::uint64_t{endpoint.scope} << 16 | endpoint.port;
  return mix(mix(mix(0, endpoint.half(0)), endpoint.half(1)), rest);
}

std::size_t std::hash<naiad::Path>::operator()(const naiad::Path& path) const noexcept {
  const std::hash<naiad::Endpoint> of;
  return naiad::mix(of(path.local), of(path.remote));
}
