// Opens streams through a gateway for browsers (server/gateway) like the gateway's page, so that bots and
// dfclient can take the page's place: each stream is a WebSocket (RFC 6455) on a connection of its own, to
// the path /play with the subprotocol naiad.1.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "client/session/StreamOpener.h"
#include "client/trust/ServerAddress.h"

namespace naiad {

class HttpExchange;

/// The system's trust store must accept the certificate of an https gateway; any other gateway must be on
/// this machine. A channel ends with CloseReason::kPeer if the gateway closed it with code 1000, as it does
/// when the server ended the stream in order.
///
/// Use from the thread that runs `context`, which must outlive this and the channels that it made.
class GatewayStreamOpener : public StreamOpener {
 public:
  /// Time limit for name look-up, connection, TLS and the WebSocket's handshake together.
  static constexpr std::chrono::seconds kOpenTimeout{10};

  GatewayStreamOpener(asio::io_context& context, GatewayAddress address);
  ~GatewayStreamOpener() override;

  void open(Done done) override { begin(m_first, std::move(done)); }
  void openSecond(Done done) override { begin(m_second, std::move(done)); }
  void cancel() override;
  /// Returns a constant, because the gateway is trusted in the server's place.
  std::optional<Fingerprint> key() const override { return keyBehindGateway(); }
  std::optional<Fingerprint> keyOfSecond() const override { return key(); }
  std::string trustError() const override { return {}; }
  bool closedDuringHandshake() const override { return false; }

 private:
  void begin(std::shared_ptr<HttpExchange>& attempt, Done done);

  asio::io_context& m_context;
  GatewayAddress m_address;
  std::shared_ptr<HttpExchange> m_first;
  std::shared_ptr<HttpExchange> m_second;
};

}  // namespace naiad
