#include "host/settings/MetricsAddress.h"

#include <algorithm>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

bool isPrivate(const asio::ip::address_v4& address) {
  const std::uint32_t bits = address.to_uint();
  const auto within = [bits](std::uint32_t network, int prefix) {
    return (bits ^ network) >> (32 - prefix) == 0;
  };
  return within(0x7f000000, 8) || within(0x0a000000, 8) || within(0xac100000, 12) || within(0xc0a80000, 16) ||
         within(0xa9fe0000, 16);
}

bool isPrivate(const asio::ip::address_v6& address) {
  const auto bytes = address.to_bytes();
  return address.is_loopback() || (bytes[0] & 0xfe) == 0xfc ||
         (bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80);
}

std::string lowerCaseOf(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

bool isNumeric(const std::string& host) {
  asio::error_code error;
  asio::ip::make_address(host, error);
  return !error;
}

}  // namespace

std::optional<MetricsAddress> MetricsAddress::parse(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = readNumber<std::uint16_t>(text.substr(colon + 1), 0, 65'535);
  if (!port) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (in_brackets) host = host.substr(1, host.size() - 2);
  asio::error_code error;
  const auto address = asio::ip::make_address(std::string(host), error);
  if (error || address.is_v6() != in_brackets) return std::nullopt;
  const auto bare = unmapped(address);
  return MetricsAddress{std::string(host), *port,
                        bare.is_v4() ? isPrivate(bare.to_v4()) : isPrivate(bare.to_v6())};
}

std::optional<MetricsHosts> MetricsHosts::parse(std::string_view names) {
  MetricsHosts hosts;
  hosts.m_names.emplace_back("localhost");
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    const std::string name = lowerCaseOf(names.substr(0, comma));
    const auto where = LinkHost::parse(name);
    if (!where || where->host != name) return std::nullopt;
    hosts.m_names.push_back(name);
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return hosts;
}

bool MetricsHosts::allows(std::string_view host) const {
  const auto where = LinkHost::parse(host);
  if (!where) return false;
  const std::string name = lowerCaseOf(where->host);
  return isNumeric(name) || std::ranges::find(m_names, name) != m_names.end();
}

}  // namespace naiad
