// What both ends of a WebSocket (RFC 6455) to a gateway for browsers agree on.
#pragma once

#include <cstdint>
#include <string_view>

namespace naiad {

/// Where the WebSockets are, and their subprotocol (RFC 6455 1.9).
inline constexpr std::string_view kPlayPath = "/play";
inline constexpr std::string_view kSubprotocol = "naiad.1";

/// Why a gateway closes a WebSocket: codes of RFC 6455 7.4.1, and from 4000 on its own (7.4.2), with a
/// sentence for people.
enum class PlayClose : std::uint16_t {
  kEnded = 1000,        ///< the server ended the stream in order
  kGoingAway = 1001,    ///< the gateway ends
  kNotBinary = 1003,    ///< a text
  kPolicy = 1008,       ///< no hello in time, or a message that is no frame
  kUnreachable = 4000,  ///< the server cannot be reached, or broke off
  kWrongKey = 4001,     ///< the server does not have the key of the link
  kTooSlow = 4002,      ///< the browser does not read
  kFull = 4003,         ///< all places are taken, or those of this address
};

}  // namespace naiad
