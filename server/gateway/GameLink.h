// The stream to the one dfserver that this gateway leads to: its visitors' socket (VisitorHeader.h), then
// TLS.
#pragma once

#include <array>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/gateway/SecureSocket.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

/// Which server that is.
struct GameServer {
  std::string socket;  ///< path of its visitors' socket
  ShortKey key;        ///< that it has to prove
  std::shared_ptr<const TlsContext> tls;
};

/// One attempt, one use. Make it with std::make_shared; handlers under way share it. No byte is written but
/// the header and OpenSSL's own until the server has proved its key.
///
/// Thread: the one that runs the io_context.
class GameLink : public std::enable_shared_from_this<GameLink> {
 public:
  enum class End { kOpen, kUnreachable, kWrongKey };
  /// Called once from the event loop, unless closed before. `problem`: why not, for the log.
  using Done = std::function<void(End end, const std::string& problem)>;

  GameLink(GatewayExecutor executor, const GameServer& server);

  /// For a visitor from there; `header` is what the server is to read first. A server that hangs up before it
  /// has proved a key is tried again for a few seconds. There is no time limit: the caller closes it.
  void open(std::string header, Done done);
  /// After End::kOpen: for bytes both ways.
  SecureSocket& stream() { return *m_stream; }
  bool isOpen() const { return m_is_open; }
  /// Hang up, in order where that can be. Operations under way fail.
  void close();

 private:
  using Local = boost::asio::local::stream_protocol;

  void connect();
  /// A little later. False if that has gone on for long enough.
  bool connectAgain();
  void onConnected(error_code error);
  void onHandshake(error_code error);
  void finish(End end, const std::string& problem);

  const GameServer& m_server;
  boost::asio::basic_stream_socket<Local, GatewayExecutor> m_socket;
  boost::asio::basic_waitable_timer<std::chrono::steady_clock,
                                    boost::asio::wait_traits<std::chrono::steady_clock>, GatewayExecutor>
      m_retry;
  std::optional<SecureSocket> m_stream;
  std::string m_header;
  std::chrono::milliseconds m_retry_delay{};
  std::chrono::steady_clock::time_point m_retry_until;
  Done m_done;  // empty: over
  bool m_is_open = false;
};

}  // namespace naiad
