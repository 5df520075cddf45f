// Whom a local program speaks for: the first bytes of a connection to a visitors' socket
// (VisitorsListener.h).
//
// Version 2 of the PROXY protocol (haproxy.org, proxy-protocol.txt, 2.2), of which one form is taken:
//
//   offset  bytes
//     0     12   0d 0a 0d 0a 00 0d 0a 51 55 49 54 0a
//    12      1   21: version 2, PROXY
//    13      1   11: TCP over IPv4, 21: TCP over IPv6
//    14      2   length of the rest, big-endian: 12 or 36, and of what follows the addresses; 216 at most
//    16    4/16  source address: the visitor's
//     …    4/16  destination address: not used
//     …     2    source port, big-endian
//     …     2    destination port
//     …          anything (TLVs): not used
//
// LOCAL, other families and UDP are refused: without an address no limit would count.
#pragma once

#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Bytes that say how long the rest is.
inline constexpr std::size_t kVisitorHeaderBegin = 16;
/// Bytes of the rest, at most.
inline constexpr std::size_t kMaxVisitorHeaderRest = 216;

/// How many bytes follow these kVisitorHeaderBegin ones; nothing if they begin no such header.
std::optional<std::size_t> visitorHeaderRest(std::string_view begin);
/// The visitor's address, of a whole header: IPv4 if it is mapped into IPv6. Nothing if `header` is none, or
/// names an address that no visitor has (unspecified, multicast, broadcast) or port 0.
std::optional<asio::ip::tcp::endpoint> readVisitorHeader(std::string_view header);
/// The same of "192.0.2.7:40000" or "[2001:db8::1]:40000".
std::optional<asio::ip::tcp::endpoint> visitorFromText(std::string_view text);
/// The header for a visitor from there, without anything behind the addresses. The destination is all zero.
std::string visitorHeader(const asio::ip::tcp::endpoint& visitor);

}  // namespace naiad
