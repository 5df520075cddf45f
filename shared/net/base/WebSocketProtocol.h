// Constants shared by both ends of a WebSocket (RFC 6455) to a gateway for browsers.
#pragma once

#include <cstdint>
#include <string_view>

namespace naiad {

/// The path of the WebSocket, and its subprotocol (RFC 6455 1.9).
inline constexpr std::string_view kPlayPath = "/play";
inline constexpr std::string_view kSubprotocol = "naiad.1";

/// The reason why a gateway closes a WebSocket: codes of RFC 6455 7.4.1, and from 4000 on private ones
/// (7.4.2). A message for people follows the code.
enum class GatewayCloseCode : std::uint16_t {
  kEnded = 1000,        ///< the server closed the stream properly
  kGoingAway = 1001,    ///< the gateway shuts down
  kNotBinary = 1003,    ///< the browser sent a text message
  kPolicy = 1008,       ///< the browser sent no hello in time, or an invalid frame
  kUnreachable = 4000,  ///< the server is unreachable, or the connection to it broke
  kWrongKey = 4001,     ///< the server's key is not the one in the player's link
  kTooSlow = 4002,      ///< the browser reads too slowly
  kFull = 4003,         ///< all places, or all places of this address, are taken
};

}  // namespace naiad
