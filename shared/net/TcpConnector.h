// Opens a TCP connection to a host and port, without blocking.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "Channel.h"
#include "TcpOptions.h"

namespace naiad {

/// One attempt at a time; may be used again after it ended, for a client that reconnects.
///
///   TcpConnector connector(context, {.receive_limit = kMaxServerFrame});
///   connector.connect("localhost", kDefaultPort, 5s, [&](auto channel, const std::string& error) { … });
///
/// Thread: the one that runs `context`, which must outlive the connector. The connector may be destroyed at
/// any time, in its own callback too; that cancels.
class TcpConnector {
 public:
  /// Either a channel, not started yet, and an empty `error`; or no channel and one sentence for people.
  using Done = std::function<void(std::unique_ptr<ReliableChannel> channel, const std::string& error)>;

  explicit TcpConnector(asio::io_context& context, TcpOptions options = {});
  ~TcpConnector();
  TcpConnector(const TcpConnector&) = delete;
  TcpConnector& operator=(const TcpConnector&) = delete;

  /// Resolve `host` (a name, or an IPv4 or IPv6 address without brackets) and try its addresses in turn.
  /// Names that do not lead to this machine are refused: loopback only. `timeout` covers everything.
  /// `done` is called once, from the event loop, unless cancelled. Cancels an attempt under way.
  void connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout, Done done);

  /// Give up; `done` will not be called. Harmless when nothing is under way. (A name look-up runs on in its
  /// own thread until the resolver's time-out; destroying the io_context waits for it.)
  void cancel();

 private:
  struct Attempt;
  asio::io_context& context_;
  TcpOptions options_;
  std::shared_ptr<Attempt> attempt_;
};

}  // namespace naiad
