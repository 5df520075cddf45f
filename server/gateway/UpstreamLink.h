// The stream to this gateway's dfserver: TLS over the visitors' socket of the server (ProxyHeader.h).
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

/// The server behind the gateway.
struct GameServer {
  std::string socket;  ///< path of the server's visitors' socket
  ShortKey key;        ///< key that the server must prove to have
  std::shared_ptr<const TlsContext> tls;
};

/// A link for one use. Make it with std::make_shared: pending handlers share it. Until the server has proved
/// that it has its key, only the header given to open() and the TLS handshake are sent.
///
/// Use on the thread that runs the io_context.
class UpstreamLink : public std::enable_shared_from_this<UpstreamLink> {
 public:
  enum class End {
    kOpen,
    kUnreachable,
    kDropped,  ///< the server closed the connection before it proved its key
    kWrongKey
  };
  /// Called once from the event loop, unless close() is called first. `problem`: reason of a failure, for the
  /// log.
  using Done = std::function<void(End end, const std::string& problem)>;

  UpstreamLink(GatewayExecutor executor, const GameServer& server);

  /// Connects. The server first reads `header`, which has the visitor's address. Retries for a few seconds if
  /// the server's backlog is full, or the server closes the connection before it has proved that it has its
  /// key. The caller must enforce a time limit.
  void open(std::string header, Done done);
  /// Returns the stream for both directions. Call only after End::kOpen.
  SecureSocket& stream() { return *m_stream; }
  bool isOpen() const { return m_is_open; }
  /// Closes the link, with a TLS shutdown if it is open. Pending operations fail.
  void close();

 private:
  using Local = boost::asio::local::stream_protocol;

  void connect();
  /// Retries after a pause. Returns false if the time for retries is over.
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
  Done m_done;  // empty: finished or closed
  bool m_is_open = false;
};

}  // namespace naiad
