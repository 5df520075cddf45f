#include "client/session/TcpStreamOpener.h"

#include <asio/io_context.hpp>
#include <utility>

#include "client/trust/KnownServers.h"
#include "shared/net/base/Limits.h"

namespace naiad {
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
