// The settings of a gateway: those of the command line, and times, which tests shorten.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/gateway/AllowedNames.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

struct GatewaySettings {
  std::optional<JoinLink> link;       ///< to the one server there is; has to be set
  std::string visitors;               ///< path of its visitors' socket
  std::string address = "127.0.0.1";  ///< numeric, to listen on
  std::uint16_t port = 8080;          ///< 0: any free one
  std::string certificate;  ///< PEM file of the web server's certificate and those above; empty: plain HTTP
  std::string key;          ///< PEM file
  std::vector<WebOrigin> origins;  ///< by which players reach it, beside its own address
  std::filesystem::path page;      ///< folder of the page's files
  std::string name;                ///< of the game, for the page

  /// Players at a time; each may have two WebSockets, for a second stream (PROTOCOL.md).
  std::size_t max_visitors = 1000;
  std::size_t max_per_address = 64;  ///< of these, from one IPv4 address or IPv6 /64
  /// Connections that are no players', and those of one address: a class that opens the page at once.
  std::size_t max_newcomers = 1024;
  std::size_t max_newcomers_per_address = 512;

  std::chrono::milliseconds head_time{5'000};   ///< from the connection to the end of its first request
  std::chrono::milliseconds idle_time{15'000};  ///< between the answer to one request and the end of the next
  std::chrono::milliseconds hello_time{10'000};  ///< from the upgrade to the first message
  std::chrono::milliseconds open_time{5'000};    ///< for the server to be connected and prove its key
  std::chrono::milliseconds stall_time{20'000};  ///< without the browser taking what there is
  std::chrono::milliseconds close_time{3'000};   ///< for the browser to answer a close
  /// Of silence, after which a browser is pinged; after twice that it is gone.
  std::chrono::milliseconds ping_time{20'000};
};

/// What became of what came. Logged when the gateway ends.
struct GatewayCounters {
  std::uint64_t connections = 0;
  std::uint64_t requests = 0;
  std::uint64_t refused_requests = 0;   ///< 4xx and 5xx
  std::uint64_t bad_requests = 0;       ///< of these: no HTTP, or too long
  std::uint64_t refused_upgrades = 0;   ///< of these: a WebSocket of another page, name or subprotocol
  std::uint64_t late = 0;               ///< hung up on: no request, no hello, or an answer not read in time
  std::uint64_t too_often = 0;          ///< hung up on: too many connections from there lately
  std::uint64_t no_place = 0;           ///< hung up on: all places are taken, or its prefix has its share
  std::uint64_t failed_handshakes = 0;  ///< of TLS with browsers
  std::uint64_t failed_accepts = 0;     ///< out of descriptors, …: put off
  std::uint64_t websockets = 0;         ///< opened
  std::uint64_t played = 0;             ///< of these: led to the server
  std::uint64_t full = 0;               ///< of these: closed with 4003
  std::uint64_t unreachable = 0;        ///< closed with 4000
  std::uint64_t wrong_keys = 0;         ///< closed with 4001
  std::uint64_t gone_silent = 0;        ///< hung up on: no answer to a ping
  std::uint64_t too_slow = 0;           ///< closed with 4002
  std::uint64_t bad_messages = 0;       ///< closed by the rules of RFC 6455 7.4, or for what is no frame
  std::uint64_t control_floods = 0;     ///< hung up on: too many pings
  std::uint64_t messages_up = 0;
  std::uint64_t messages_down = 0;
  std::uint64_t writes_up =
      0;  ///< in which these were sent: several messages that were there together are one
  std::uint64_t writes_down = 0;
};

}  // namespace naiad
