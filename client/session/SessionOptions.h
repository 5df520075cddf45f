// Options of a client's session: contents of the hello, and sources of sockets and time.
#pragma once

#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/Seal.h"

namespace naiad {
namespace wire {
class ClientMessage;
}

/// Options of a program on the server's machine that joins on behalf of a remote player (ProxyListener.h).
struct ProxyOptions {
  std::string socket;               ///< path of the visitors' socket
  asio::ip::tcp::endpoint visitor;  ///< address of the player
};

struct SessionOptions {
  std::string name = "player";  ///< requested name, 1 to 16 characters
  std::string game;             ///< requested game; empty: any
  std::string room;             ///< first room; empty: the server's first, or one that plays `game`
  bool stays_in_room = false;   ///< a resumed session ignores `room` and stays in its room
  std::string program;          ///< name and version for the server's log: "dfclient 0.2.0"
  int columns = 0;              ///< terminal size in cells; 0: unknown
  int rows = 0;
  std::string password;               ///< password of the server, if it needs one
  std::string resume_token;           ///< token of an earlier session, to resume it; empty: a new session
  bool new_process = false;           ///< another process had the session, so only the token is known
  std::uint32_t last_frame = 0;       ///< without new_process: number of the newest reliable frame received
  bool second_stream = false;         ///< this is a second stream of the token's session
  bool two_streams = false;           ///< open a second stream immediately, because datagrams are impossible
  std::optional<ProxyOptions> proxy;  ///< set for a remote player; then there are no datagrams
  /// Makes a socket for datagrams to an endpoint; may return null. Empty: no datagrams. If empty, a
  /// Connection by TCP and TLS sets it to make UDP sockets.
  std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> open_socket;
  /// Numbers of datagrams after which keys are renewed; tests set smaller numbers.
  SealLimits seal_limits;
  /// The clock for datagrams; tests in virtual time set another one.
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

wire::ClientMessage helloOf(const SessionOptions& options);
/// Returns a message with the terminal's size in cells, clamped to 0 to 9999.
wire::ClientMessage resizeOf(int columns, int rows);

}  // namespace naiad
