// Opens streams by TCP and TLS: to the server directly, or through its visitors' socket.
#pragma once

#include <asio/ip/address.hpp>
#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/session/SessionOptions.h"
#include "client/session/StreamOpener.h"
#include "client/trust/ServerAddress.h"
#include "shared/net/stream/TcpConnector.h"

namespace naiad {

/// Use from the thread that runs the context, which must outlive this object.
class TcpStreamOpener : public StreamOpener {
 public:
  static constexpr std::chrono::milliseconds kConnectTimeout{5000};

  /// `proxy`: connect through this socket for a remote player.
  TcpStreamOpener(asio::io_context& context, ServerAddress address, ServerTrust trust,
                  std::optional<ProxyOptions> proxy);

  void open(Done done) override;
  void openSecond(Done done) override { connect(m_second_connector, std::move(done)); }
  void cancel() override;
  std::optional<Fingerprint> key() const override { return keyOf(m_connector); }
  std::optional<Fingerprint> keyOfSecond() const override { return keyOf(m_second_connector); }
  std::string trustError() const override;
  /// Refuses redirects for visitors of a door, without TLS, with ServerTrust::ignore_redirects, after a
  /// redirect, and by links with a room or a port below 1024. The target's addresses must not have a narrower
  /// scope than this server's (mayRedirectTo()).
  RedirectTarget follow(const std::string& link) override;
  bool closedDuringHandshake() const override { return m_connector.closedDuringHandshake(); }

  static constexpr std::uint16_t kMinRedirectPort = 1024;

 private:
  static std::optional<Fingerprint> keyOf(const TcpConnector& connector);
  void connect(TcpConnector& connector, Done done);

  ServerAddress m_address;
  ServerTrust m_trust;
  asio::io_context& m_context;
  std::optional<ProxyOptions> m_proxy;
  std::optional<asio::ip::address> m_peer;  ///< address of the newest stream of open()
  TcpConnector m_connector;
  TcpConnector m_second_connector;
};

}  // namespace naiad
