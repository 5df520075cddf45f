// A client that joins over TLS from its own address, without datagrams, and follows the test's commands.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "Relay.h"
#include "client/session/ClientSession.h"
#include "shared/net/stream/TcpConnector.h"

namespace bench::attack {

class Guest {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class State {
    kJoining,
    kPlaying,
    kRefusedForNow,
    kRefused,
    kLost  ///< the client was disconnected, timed out, or has ended
  };

  /// Begins to connect from the address `source`. Its destructor acts, for the server, like killing the
  /// client's process.
  Guest(asio::io_context& context, std::uint16_t server_port, const std::string& source,
        const naiad::SessionOptions& options);

  void update(Time now);
  State state() const { return m_state; }
  bool isOver() const { return m_state != State::kJoining && m_state != State::kPlaying; }
  /// True if the client is in the game and has received a picture.
  bool hasPicture(Time now) const { return m_state == State::kPlaying && m_session->hasPicture(now); }
  /// Returns the session; null before the client is connected.
  naiad::ClientSession* session() { return m_session.get(); }

 private:
  void attach(std::unique_ptr<naiad::ReliableChannel> channel, const naiad::SessionOptions& options);

  State m_state = State::kJoining;
  Relay m_relay;
  naiad::TcpConnector m_connector;
  std::unique_ptr<naiad::ClientSession> m_session;
};

/// Returns options for a guest of this name.
naiad::SessionOptions guestOptions(const std::string& name, const std::string& password);

/// Returns a chat line of maximum length that consists of characters of three bytes.
std::string longLine();

/// Returns the TLS context of all guests of this thread. It is made once, because making it reads the
/// system's certificates.
std::shared_ptr<const naiad::TlsContext> clientTls();

/// Returns address `n` of a network: 127.`network`.x.y, beginning with 127.`network`.0.1 for 0.
std::string addressIn(int network, int n);

}  // namespace bench::attack
