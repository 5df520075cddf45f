// What a client says in its hello, and where it gets sockets and time.
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

/// How a program on the server's machine joins on behalf of a remote player (VisitorsListener.h).
struct Visit {
  std::string socket;               ///< path of the visitors' socket
  asio::ip::tcp::endpoint visitor;  ///< where they are
};

/// What the Hello says.
struct SessionOptions {
  std::string name = "player";  ///< wanted name, 1 to 16 characters
  std::string game;             ///< game to play; empty: whatever runs
  std::string room;             ///< to begin in; empty: the first, or one that plays `game`
  bool stays_in_room = false;   ///< a session that goes on stays in the room where it was, whatever `room` is
  std::string program;          ///< "dfclient 0.2.0", for the server's log
  int columns = 0;              ///< terminal size in cells; 0: all of the view is of interest
  int rows = 0;
  std::string password;        ///< of the server, if it needs one
  std::string resume_token;    ///< of an earlier welcome: go on with that session
  bool fresh = false;          ///< with nothing but the token: an earlier process had the session
  std::uint32_t received = 0;  ///< else: number of the newest reliable frame received
  bool second_stream = false;  ///< with the token: a stream beside that of the session
  bool two_streams = false;    ///< there are no datagrams to wait for: open a second stream immediately
  std::optional<Visit> visit;  ///< empty: this program is the player's own. Else there are no datagrams
  /// Makes a socket for datagrams to an endpoint; empty: no datagrams (a Connection that encrypts puts UDP
  /// there). May return null.
  std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> open_socket;
  /// After how many datagrams new keys are wanted; smaller ones are for tests.
  SealLimits seal_limits;
  /// The clock for datagrams; tests in virtual time set another one.
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// The first message of a stream.
wire::ClientMessage helloOf(const SessionOptions& options);
/// The terminal's size, in cells; clamped to what the wire can carry.
wire::ClientMessage resizeOf(int columns, int rows);

}  // namespace naiad
