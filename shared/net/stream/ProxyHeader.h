// The header with which a local program gives its visitor's address: the first bytes of a connection to a
// visitors' socket (ProxyListener.h).
//
// Version 2 of the PROXY protocol (haproxy.org, proxy-protocol.txt, 2.2), of which one form is accepted:
//
//   offset  bytes
//     0     12   0d 0a 0d 0a 00 0d 0a 51 55 49 54 0a
//    12      1   21: version 2, PROXY
//    13      1   11: TCP over IPv4, 21: TCP over IPv6
//    14      2   length of the rest, big-endian: 12 or 36 plus the TLVs; at most 216
//    16    4/16  source address: the visitor's
//     …    4/16  destination address: not used
//     …     2    source port, big-endian
//     …     2    destination port
//     …          anything (TLVs): not used
//
// The command LOCAL, other families and UDP are refused, because limits need an address.
#pragma once

#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Size of the first part of the header, which contains the length of the rest.
inline constexpr std::size_t kProxyHeaderBegin = 16;
/// Largest size of the rest of the header, in bytes.
inline constexpr std::size_t kMaxProxyHeaderRest = 216;

/// Returns the size of the rest of the header, given its first kProxyHeaderBegin bytes; nullopt if they are
/// invalid.
std::optional<std::size_t> proxyHeaderRest(std::string_view begin);
/// Returns the visitor's address from a complete header, mapped IPv4 as IPv4. Returns nullopt if `header` is
/// invalid, or has port 0 or an address that no visitor has (unspecified, multicast, broadcast).
std::optional<asio::ip::tcp::endpoint> readProxyHeader(std::string_view header);
/// Like readProxyHeader(), but from a text "192.0.2.7:40000" or "[2001:db8::1]:40000".
std::optional<asio::ip::tcp::endpoint> proxiedPeerFromText(std::string_view text);
/// Returns the header for this visitor, without TLVs. The destination is all zero.
std::string proxyHeader(const asio::ip::tcp::endpoint& visitor);

}  // namespace naiad
