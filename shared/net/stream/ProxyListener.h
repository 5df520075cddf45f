// Accepts connections from local programs between the server and its visitors: an ssh door, a gateway for
// browsers. Each connection begins with the visitor's address (ProxyHeader.h), then continues like a
// connection from that address.
//
// It listens on a Unix domain socket. Only processes that can open this socket may state a visitor's address;
// no other listener reads such a header.
#pragma once

#include <sys/types.h>

#include <asio/generic/stream_protocol.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

namespace naiad {

struct ProxyListenerOptions {
  std::filesystem::path path;  ///< path of the socket, at most 107 bytes; empty: none
  /// Time limit from accepting a connection to the end of its header.
  std::chrono::milliseconds header_timeout{2000};
  /// Limit of connections with an incomplete header; further ones are dropped.
  std::size_t max_waiting = 64;
  /// True for processes whose connections are refused: those that the server itself has started. May be
  /// empty. Called from the listener's event loop, once per connection.
  std::function<bool(pid_t process)> is_refused = nullptr;
};

/// Thread: the one that runs `context`, which must outlive the listener. The listener may be destroyed at any
/// time.
class ProxyListener {
 public:
  /// Receives a connection from the visitor at `address`. The next bytes to read are the visitor's own.
  using PeerHandler = std::function<void(asio::generic::stream_protocol::socket socket,
                                         const asio::ip::tcp::endpoint& address)>;

  struct Counters {
    std::uint64_t visitors = 0;        ///< delivered
    std::uint64_t bad_headers = 0;     ///< dropped: header invalid, truncated or without a visitor's address
    std::uint64_t late_headers = 0;    ///< dropped: not complete in time
    std::uint64_t crowded = 0;         ///< dropped: too many connections waited
    std::uint64_t refused_peers = 0;   ///< dropped: ProxyListenerOptions::is_refused() returned true
    std::uint64_t failed_accepts = 0;  ///< failed accepts, for example without descriptors; retried
  };

  /// Starts to listen. The file has mode 0660 (and the folder's group if the folder has the set-group-id
  /// bit). Replaces a socket without a listening process. Throws ListenError (TcpListener.h) for other
  /// existing files, a socket in use, invalid paths, and errors of the system.
  ProxyListener(asio::io_context& context, ProxyListenerOptions options, PeerHandler on_peer);
  ~ProxyListener();
  ProxyListener(const ProxyListener&) = delete;
  ProxyListener& operator=(const ProxyListener&) = delete;

  const Counters& counters() const;
  /// The number of connections with an incomplete header.
  std::size_t waiting() const;
  /// Stops listening; no callback runs after this. Removes the file unless another server has replaced it.
  void close();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
