// Takes connections from programs of this machine that stand between the server and its visitors: an ssh
// door, a gateway for browsers. Each begins with the visitor's address (VisitorHeader.h), and goes on as a
// connection from there would.
//
// A socket of the file system (AF_UNIX): who may open the file is trusted with addresses, nobody else. No
// such header is read anywhere else.
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

struct VisitorsListening {
  std::filesystem::path path;  ///< of the socket, 107 bytes at most; empty: none
  /// From accepting a connection to the end of its header.
  std::chrono::milliseconds header_timeout{2000};
  /// Connections whose header is not complete; further ones are hung up on.
  std::size_t max_waiting = 64;
  /// Programs that may not speak for others, by their process: what the server has started itself. May be
  /// empty. Called from the listener's event loop, once for each connection.
  std::function<bool(pid_t process)> is_refused = nullptr;
};

/// Thread: the one that runs `context`, which must outlive the listener. The listener may be destroyed at any
/// time.
class VisitorsListener {
 public:
  /// A visitor from `address` has come; what they say begins now.
  using OnVisitor = std::function<void(asio::generic::stream_protocol::socket socket,
                                       const asio::ip::tcp::endpoint& address)>;

  /// What became of connections so far.
  struct Counters {
    std::uint64_t visitors = 0;        ///< given out
    std::uint64_t bad_headers = 0;     ///< hung up on: no header, or one that names no visitor's address
    std::uint64_t late_headers = 0;    ///< hung up on: not complete in time
    std::uint64_t crowded = 0;         ///< hung up on: too many waited
    std::uint64_t refused_peers = 0;   ///< hung up on: VisitorsListening::is_refused
    std::uint64_t failed_accepts = 0;  ///< out of descriptors, …: put off
  };

  /// Listens from now on. The file has mode 0660 (its group is that of the folder, where that has its
  /// set-group-id bit). A socket on which nobody listens is replaced; one that is in use, and anything else,
  /// is not: throws ListenError (TcpListener.h), as for a path that cannot be used.
  VisitorsListener(asio::io_context& context, VisitorsListening options, OnVisitor on_visitor);
  /// Removes the file.
  ~VisitorsListener();
  VisitorsListener(const VisitorsListener&) = delete;
  VisitorsListener& operator=(const VisitorsListener&) = delete;

  const Counters& counters() const;
  /// Connections whose header is not complete.
  std::size_t waiting() const;
  /// Stop listening, and remove the file; no callback after this.
  void close();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
