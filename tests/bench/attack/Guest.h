// A client that joins over TLS from its own address, without datagrams, and follows the attack's commands.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "client/session/ClientSession.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsStream.h"

namespace bench::attack {

/// Opens a stream from one of this machine's addresses to the server. The destructor cancels.
class Dial {
 public:
  /// Receives a channel that is not started; null on failure.
  using Done = std::function<void(std::unique_ptr<naiad::ReliableChannel> channel)>;

  Dial(asio::io_context& context, const std::string& source, std::uint16_t server_port, Done done)
      : m_call(std::make_shared<Call>(Call{asio::ip::tcp::socket(context), nullptr, std::move(done)})) {
    asio::error_code error;
    m_call->socket.open(asio::ip::tcp::v4(), error);
    if (!error) m_call->socket.bind({asio::ip::make_address(source), 0}, error);
    m_call->socket.async_connect({asio::ip::address_v4::loopback(), server_port},
                                 [call = m_call](const asio::error_code& refused) {
                                   if (!call->done) return;
                                   refused ? call->done(nullptr) : call->shakeHands();
                                 });
  }
  ~Dial() {
    m_call->done = nullptr;
    m_call->socket = asio::ip::tcp::socket(m_call->socket.get_executor());
    if (m_call->handshake) m_call->handshake->cancel();
  }
  Dial(const Dial&) = delete;
  Dial& operator=(const Dial&) = delete;

 private:
  struct Call {
    void shakeHands() {
      // Each thread has its own context, because threads must not share one. Making it reads many files.
      thread_local const auto s_tls = naiad::TlsContext::forClient();
      handshake = std::make_shared<naiad::TlsHandshake>(
          std::make_unique<naiad::TlsStream>(std::move(socket), s_tls, "127.0.0.1"));
      handshake->run(std::chrono::seconds(5), [this](auto, auto stream, const std::string&) {
        if (!stream) return done(nullptr);
        done(naiad::makeTcpChannel(std::move(stream), {.receive_limit = naiad::kMaxServerFrame}));
      });
    }
    asio::ip::tcp::socket socket;
    std::shared_ptr<naiad::TlsHandshake> handshake;
    Done done;  ///< empty after the destructor
  };
  std::shared_ptr<Call> m_call;
};

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
        const std::string& name, const std::string& password)
      : m_dial(context, source, server_port,
               [this, name, password](std::unique_ptr<naiad::ReliableChannel> channel) {
                 if (channel) return attach(std::move(channel), name, password);
                 m_state = State::kLost;
               }) {}

  void update(Time now) {
    using Session = naiad::ClientSession::State;
    if (!m_session || isOver()) return;
    m_session->update(now);
    if (m_session->state() == Session::kGreeting) return;
    m_state = State::kLost;
    if (m_session->state() == Session::kPlaying && !m_session->isDetached()) m_state = State::kPlaying;
    if (m_session->state() == Session::kRefused)
      m_state = m_session->refusal().is_temporary ? State::kRefusedForNow : State::kRefused;
  }
  State state() const { return m_state; }
  bool isOver() const { return m_state != State::kJoining && m_state != State::kPlaying; }
  /// True if the client is in the game and has received a picture.
  bool hasPicture(Time now) const { return m_state == State::kPlaying && m_session->hasPicture(now); }
  /// Returns the session; null before the client is connected.
  naiad::ClientSession* session() { return m_session.get(); }

 private:
  void attach(std::unique_ptr<naiad::ReliableChannel> channel, const std::string& name,
              const std::string& password) {
    naiad::ReliableChannel& started = *channel;
    const auto clock = &std::chrono::steady_clock::now;
    naiad::SessionOptions options;
    options.name = name;
    options.program = "naiad_attack";
    options.password = password;
    m_session = std::make_unique<naiad::ClientSession>(std::move(channel), options, clock());
    started.start({[this, clock](std::string_view frame) { m_session->receive(frame, clock()); },
                   [this](naiad::CloseReason reason) { m_session->closed(reason); }});
  }

  State m_state = State::kJoining;
  Dial m_dial;
  std::unique_ptr<naiad::ClientSession> m_session;
};

/// Returns a chat line of maximum length that consists of characters of three bytes.
inline std::string longLine() {
  std::string line;
  for (std::size_t i = 0; i < naiad::kMaxChatLength; ++i) line += "\u2588";
  return line;
}

/// Returns address `n` of a network: 127.`network`.x.y, beginning with 127.`network`.0.1 for 0.
inline std::string addressIn(int network, int n) {
  return "127." + std::to_string(network) + "." + std::to_string(n / 250) + "." + std::to_string(1 + n % 250);
}

}  // namespace bench::attack
