// Stands between one client and the server: gives it an address of its own, a longer way, or none.
//
// Bytes of the stream are passed on as they are, so TLS runs from end to end. Datagrams go through the same
// port number, as the protocol wants it.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

namespace bench::attack {

class Relay {
 public:
  struct Options {
    std::string source = "127.0.0.1";    ///< the client's address as the server sees it
    std::chrono::milliseconds delay{0};  ///< in each direction
    bool datagrams = false;              ///< pass them, too
  };

  /// Runs in `context`, which must outlive it. Throws std::system_error.
  Relay(asio::io_context& context, std::uint16_t server_port, const Options& options);
  /// As cut().
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Clients connect here, on 127.0.0.1.
  std::uint16_t port() const;
  /// Both ends of all present connections lose them.
  void cut();
  /// While closed, later connections end at once and datagrams are lost.
  void setOpen(bool open);

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace bench::attack
