// Waits for TCP connections on one address and port.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "Channel.h"
#include "TcpOptions.h"

namespace naiad {

/// A listener could not be made. what() is one sentence for people: "Port 9876 on 127.0.0.1 is in use …".
class ListenError : public std::runtime_error {
 public:
  ListenError(const std::string& sentence, std::error_code code)
      : std::runtime_error(sentence), code_(code) {}
  /// The cause, e.g. std::errc::address_in_use; std::errc::invalid_argument for an address refused here.
  std::error_code code() const { return code_; }

 private:
  std::error_code code_;
};

/// Accepts until closed or destroyed. Running out of descriptors or memory does not end it: it waits 100 ms
/// and tries again, while the connections wait in the kernel's backlog.
///
/// Thread: the one that runs `context`, which must outlive the listener. The listener may be destroyed at
/// any time, in its own callback too. Channels it gave out do not depend on it.
class TcpListener {
 public:
  /// A connection was accepted. The channel is not started yet; dropping it hangs up.
  using OnChannel = std::function<void(std::unique_ptr<ReliableChannel> channel)>;

  /// Listens from now on; `on_channel` is called from the event loop. `address`: numeric, IPv4 or IPv6,
  /// loopback only ("127.0.0.1", "::1"). `port`: 0 takes any free one. SO_REUSEADDR is set, so a restart
  /// need not wait for old connections to time out. Throws ListenError.
  TcpListener(asio::io_context& context, const std::string& address, std::uint16_t port, OnChannel on_channel,
              TcpOptions options = {});
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// The port listened on, also when 0 was asked for.
  std::uint16_t port() const;
  /// "127.0.0.1:40000" or "[::1]:40000", for logs.
  std::string address() const;
  /// How often accepting failed (out of descriptors, …) and was put off.
  std::uint64_t failedAccepts() const;

  /// Stop listening; no callback after this. Connections not accepted yet are reset by the kernel.
  void close();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
