// A relay between one client and the server: changes the client's address, delays or breaks its connection.
//
// Bytes of the stream are passed on unchanged, so TLS runs from end to end. Datagrams use an equal port
// number, as the protocol requires.
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
    std::chrono::milliseconds delay{0};  ///< added in each direction
    bool datagrams = false;              ///< relay datagrams, too
  };

  /// Runs in `context`, which must outlive the relay. Throws std::system_error if no port is free.
  Relay(asio::io_context& context, std::uint16_t server_port, const Options& options);
  /// Calls cut().
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Returns the port on 127.0.0.1 to which the client connects.
  std::uint16_t port() const;
  /// Closes both ends of all present connections.
  void cut();
  /// If `open` is false, later connections are closed at once, and datagrams are lost.
  void setOpen(bool open);

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace bench::attack
