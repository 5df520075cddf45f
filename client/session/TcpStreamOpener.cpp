#include "client/session/TcpStreamOpener.h"

#include <asio/io_context.hpp>
#include <utility>

#include "client/session/Connection.h"
#include "client/session/GatewayStreams.h"
#include "client/trust/KnownServers.h"
#include "shared/net/base/Limits.h"
#include "shared/net/datagram/UdpSocket.h"

namespace naiad {
namespace {

SessionOptions withDatagrams(asio::io_context& context, const SessionOptions& given,
                             const ServerTrust& trust) {
  SessionOptions options = given;
  options.two_streams = trust.gateway.has_value();
  if (trust.insecure || trust.gateway || options.open_socket || options.visit) return options;
  options.open_socket = [&context](const Endpoint& server) -> std::unique_ptr<DatagramSocket> {
    UdpOptions udp;
    udp.address = server.isIPv4() ? "0.0.0.0" : "::";
    try {
      return std::make_unique<UdpSocket>(context, udp);
    } catch (const ListenError&) {
      return nullptr;  // the stream is enough
    }
  };
  return options;
}

std::unique_ptr<StreamOpener> openerOf(asio::io_context& context, const ServerAddress& address,
                                       const SessionOptions& options, const ServerTrust& trust) {
  if (trust.gateway) return std::make_unique<GatewayStreams>(context, *trust.gateway);
  return std::make_unique<TcpStreamOpener>(context, address, trust, options.visit);
}

}  // namespace

Connection::Connection(asio::io_context& context, const ServerAddress& address, const SessionOptions& options,
                       bool rejoin, const ServerTrust& trust)
    : Connection(openerOf(context, address, options, trust), address, withDatagrams(context, options, trust),
                 rejoin) {}

TcpStreamOpener::TcpStreamOpener(asio::io_context& context, ServerAddress address, ServerTrust trust,
                                 std::optional<Visit> visit)
    : m_address(std::move(address)),
      m_trust(std::move(trust)),
      m_visit(std::move(visit)),
      m_connector(context, TcpOptions{.receive_limit = kMaxServerFrame},
                  m_trust.insecure ? nullptr : TlsContext::forClient()),
      m_second_connector(context, TcpOptions{.receive_limit = kMaxServerFrame}, TlsContext::forClient()) {}

void TcpStreamOpener::connect(TcpConnector& connector, Done done) {
  if (!m_visit) return connector.connect(m_address.host, m_address.port, kConnectTimeout, std::move(done));
  connector.connectFor(m_visit->visitor, m_visit->socket, m_address.host, m_address.port, kConnectTimeout,
                       std::move(done));
}

void TcpStreamOpener::cancel() {
  m_connector.cancel();
  m_second_connector.cancel();
}

std::optional<Fingerprint> TcpStreamOpener::keyOf(const TcpConnector& connector) {
  const auto& facts = connector.peerFacts();
  return facts ? std::optional(facts->key) : std::nullopt;
}

std::string TcpStreamOpener::whyUntrusted() const {
  if (m_trust.insecure || !m_connector.peerFacts()) return {};
  try {
    const KnownServers known(m_trust.known_servers.empty() ? KnownServers::defaultPath()
                                                           : m_trust.known_servers);
    const Verdict verdict = known.admit(m_address.host, m_address.port, *m_connector.peerFacts(),
                                        m_trust.fingerprint, m_trust.link_key);
    return verdict.accepted() ? std::string() : verdict.sentence;
  } catch (const KnownServersError& error) {
    return error.what();
  }
}

}  // namespace naiad
