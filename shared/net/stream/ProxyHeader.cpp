#include "shared/net/stream/ProxyHeader.h"

#include <asio/ip/address.hpp>
#include <cstdint>
#include <cstring>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

using asio::ip::tcp;

constexpr std::string_view kSignature("\r\n\r\n\0\r\nQUIT\n", 12);
constexpr unsigned char kProxy = 0x21;
constexpr unsigned char kTcpIPv4 = 0x11;
constexpr unsigned char kTcpIPv6 = 0x21;
constexpr std::size_t kPorts = 4;  // bytes of both ports

unsigned byteAt(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

unsigned wordAt(std::string_view text, std::size_t at) {
  return byteAt(text, at) << 8 | byteAt(text, at + 1);
}

template <class Address>
Address addressAt(std::string_view text, std::size_t at) {
  typename Address::bytes_type bytes;
  std::memcpy(bytes.data(), text.data() + at, bytes.size());
  return Address(bytes);
}

std::size_t addressBytes(std::string_view header) {
  return byteAt(header, 13) == kTcpIPv4 ? 4 : 16;
}

bool isVisitors(const asio::ip::address& address) {
  const bool broadcast = address.is_v4() && address.to_v4() == asio::ip::address_v4::broadcast();
  return !address.is_unspecified() && !address.is_multicast() && !broadcast;
}

void addWord(std::string& text, unsigned word) {
  text.push_back(static_cast<char>(word >> 8 & 0xff));
  text.push_back(static_cast<char>(word & 0xff));
}

template <class Address>
void addAddresses(std::string& text, const Address& source) {
  const auto bytes = source.to_bytes();
  text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  text.append(bytes.size(), '\0');
}

}  // namespace

std::optional<std::size_t> proxyHeaderRest(std::string_view begin) {
  if (begin.size() != kProxyHeaderBegin || !begin.starts_with(kSignature)) return std::nullopt;
  const unsigned family = byteAt(begin, 13);
  if (byteAt(begin, 12) != kProxy || (family != kTcpIPv4 && family != kTcpIPv6)) return std::nullopt;
  const std::size_t rest = wordAt(begin, 14);
  if (rest < 2 * addressBytes(begin) + kPorts || rest > kMaxProxyHeaderRest) return std::nullopt;
  return rest;
}

std::optional<tcp::endpoint> readProxyHeader(std::string_view header) {
  const auto rest = proxyHeaderRest(header.substr(0, kProxyHeaderBegin));
  if (!rest || header.size() != kProxyHeaderBegin + *rest) return std::nullopt;
  const std::size_t size = addressBytes(header);
  const asio::ip::address address =
      unmapped(size == 4 ? asio::ip::address(addressAt<asio::ip::address_v4>(header, kProxyHeaderBegin))
                         : asio::ip::address(addressAt<asio::ip::address_v6>(header, kProxyHeaderBegin)));
  const unsigned port = wordAt(header, kProxyHeaderBegin + 2 * size);
  if (!isVisitors(address) || port == 0) return std::nullopt;
  return tcp::endpoint(address, static_cast<std::uint16_t>(port));
}

std::optional<tcp::endpoint> proxiedPeerFromText(std::string_view text) {
  const auto endpoint = NumericEndpoint::parse(text);
  if (!endpoint || endpoint->port == 0 || !isVisitors(unmapped(endpoint->address))) return std::nullopt;
  return tcp::endpoint(unmapped(endpoint->address), endpoint->port);
}

std::string proxyHeader(const tcp::endpoint& visitor) {
  const asio::ip::address address = unmapped(visitor.address());
  std::string header(kSignature);
  header.push_back(static_cast<char>(kProxy));
  header.push_back(static_cast<char>(address.is_v4() ? kTcpIPv4 : kTcpIPv6));
  addWord(header, static_cast<unsigned>(2 * std::size_t{address.is_v4() ? 4u : 16u} + kPorts));
  address.is_v4() ? addAddresses(header, address.to_v4()) : addAddresses(header, address.to_v6());
  addWord(header, visitor.port());
  addWord(header, 0);
  return header;
}

}  // namespace naiad
