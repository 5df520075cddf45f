// Opens streams by TCP and TLS: straight to the server, or by way of a visitors' socket.
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

/// Thread: the one that runs the context, which must outlive it.
class TcpStreamOpener : public StreamOpener {
 public:
  static constexpr std::chrono::milliseconds kConnectTimeout{5000};

  /// `visit`: by way of that socket, for the player who is there.
  TcpStreamOpener(asio::io_context& context, ServerAddress address, ServerTrust trust,
                  std::optional<Visit> visit);

  void open(Done done) override;
  void openSecond(Done done) override { connect(m_second_connector, std::move(done)); }
  void cancel() override;
  std::optional<Fingerprint> key() const override { return keyOf(m_connector); }
  std::optional<Fingerprint> secondKey() const override { return keyOf(m_second_connector); }
  std::string whyUntrusted() const override;
  /// Not for a visitor, whose door leads to its own servers; not without encryption, nor from a server to
  /// which another one has sent the client, nor to a port of the system's. Addresses there are never nearer
  /// than this server's.
  Next follow(const std::string& link) override;
  bool wasHungUpOn() const override { return m_connector.wasHungUpOn(); }

  static constexpr std::uint16_t kLeastFollowedPort = 1024;

 private:
  static std::optional<Fingerprint> keyOf(const TcpConnector& connector);
  void connect(TcpConnector& connector, Done done);

  ServerAddress m_address;
  ServerTrust m_trust;
  asio::io_context& m_context;
  std::optional<Visit> m_visit;
  std::optional<asio::ip::address> m_peer;  ///< of the newest stream of open()
  TcpConnector m_connector;
  TcpConnector m_second_connector;
};

}  // namespace naiad
