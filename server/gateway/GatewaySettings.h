// The settings of a gateway: command line options, and timeouts, which tests shorten.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/gateway/AllowedOrigins.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

struct GatewaySettings {
  std::optional<JoinLink> link;       ///< link to the server; must be set
  std::string visitors;               ///< path of the server's visitors' socket (dfserver --proxy-socket)
  std::string address = "127.0.0.1";  ///< numeric address to listen on
  std::uint16_t port = 8080;          ///< 0: any free port
  std::string certificate;            ///< PEM file of the web server's certificate chain; empty: plain HTTP
  std::string key;                    ///< PEM file of the certificate's private key
  std::vector<WebOrigin> origins;  ///< origins of the page for players, in addition to the listening address
  std::filesystem::path page;      ///< folder of the page's files
  std::string name;                ///< name of the game, shown on the page

  /// Maximum number of players. Each may have two WebSockets, for a second stream (PROTOCOL.md).
  std::size_t max_visitors = 1000;
  std::size_t max_per_address = 64;  ///< maximum players from one IPv4 address or IPv6 /64
  /// Maximum connections that do not play yet, in all and per address. Enough for a class that opens the page
  /// all at once.
  std::size_t max_pending = 1024;
  std::size_t max_pending_per_address = 512;

  std::chrono::milliseconds head_timeout{5'000};    ///< timeout from accept to the end of the first request
  std::chrono::milliseconds idle_timeout{15'000};   ///< timeout from an answer to the end of the next request
  std::chrono::milliseconds hello_timeout{10'000};  ///< timeout from the upgrade request to the first message
  std::chrono::milliseconds connect_timeout{
      5'000};  ///< timeout until the server is connected and has proved that it has its key
  std::chrono::milliseconds stall_timeout{20'000};  ///< timeout until a browser has taken the last data
  std::chrono::milliseconds close_timeout{3'000};   ///< timeout of a browser's answer to a close
  /// Idle time before a ping; twice this disconnects the browser.
  std::chrono::milliseconds ping_interval{20'000};
};

/// Counters, logged when the gateway ends.
struct GatewayCounters {
  std::uint64_t connections = 0;
  std::uint64_t requests = 0;
  std::uint64_t refused_requests = 0;   ///< answered with status 4xx or 5xx
  std::uint64_t bad_requests = 0;       ///< refused: invalid HTTP, or too long
  std::uint64_t refused_upgrades = 0;   ///< refused: WebSocket with a wrong origin, host or subprotocol
  std::uint64_t timeouts = 0;           ///< dropped: no request or hello came in time, or no answer was read
  std::uint64_t rate_limited = 0;       ///< dropped: too many recent connections from the address
  std::uint64_t no_slot = 0;            ///< dropped: too many pending connections, in all or of the address
  std::uint64_t failed_handshakes = 0;  ///< failed TLS handshakes with browsers
  std::uint64_t failed_accepts = 0;     ///< failed accepts (out of descriptors and the like); retried
  std::uint64_t websockets = 0;         ///< opened WebSockets
  std::uint64_t played = 0;             ///< WebSockets connected to the server
  std::uint64_t full = 0;               ///< WebSockets closed with code 4003: too many players
  std::uint64_t unreachable = 0;        ///< WebSockets closed with code 4000: server not reachable or lost
  std::uint64_t wrong_keys = 0;         ///< WebSockets closed with code 4001: wrong key of the server
  std::uint64_t ping_timeouts = 0;      ///< dropped: no answer to a ping
  std::uint64_t stalled = 0;            ///< WebSockets closed with code 4002: browser too slow
  std::uint64_t bad_messages = 0;       ///< closed: violation of RFC 6455, or message empty or not binary
  std::uint64_t control_floods = 0;     ///< dropped: too many pings and pongs
  std::uint64_t messages_up = 0;
  std::uint64_t messages_down = 0;
  std::uint64_t writes_up = 0;  ///< writes to the server; one write may carry several messages
  std::uint64_t writes_down = 0;
};

}  // namespace naiad
