// A client that joins over TLS from an address of its own, without datagrams, and does as it is asked.
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
    kLost  ///< hung up on, no answer, ended
  };

  /// Begins to connect from the address `source`. Destroying it is as if its process was killed.
  Guest(asio::io_context& context, std::uint16_t server_port, const std::string& source,
        const naiad::SessionOptions& options);

  void update(Time now);
  State state() const { return m_state; }
  bool isOver() const { return m_state != State::kJoining && m_state != State::kPlaying; }
  /// There is a picture.
  bool hasPicture(Time now) const { return m_state == State::kPlaying && m_session->hasPicture(now); }
  /// Null before there is a connection.
  naiad::ClientSession* session() { return m_session.get(); }

 private:
  void attach(std::unique_ptr<naiad::ReliableChannel> channel, const naiad::SessionOptions& options);

  State m_state = State::kJoining;
  Relay m_relay;
  naiad::TcpConnector m_connector;
  std::unique_ptr<naiad::ClientSession> m_session;
};

/// Options of a guest of this name.
naiad::SessionOptions guestOptions(const std::string& name, const std::string& password);

/// A line of chat of the greatest length, in characters of three bytes.
std::string longLine();

/// What the trust of all guests is based on: made once, it reads the system's certificates.
std::shared_ptr<const naiad::TlsContext> clientTls();

/// The n-th address of a network: 127.`network`.x.y, from 127.`network`.0.1 on.
std::string addressIn(int network, int n);

}  // namespace bench::attack
