#include "client/session/TcpStreamOpener.h"

#include <asio/io_context.hpp>
#include <random>
#include <utility>
#include <variant>

#include "client/trust/KnownServers.h"
#include "shared/net/base/AddressRange.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

/// Returns the TLS context that a thread's connections share: reading the system's trust store takes 20 ms.
const std::shared_ptr<const TlsContext>& clientContext() {
  thread_local const std::shared_ptr<const TlsContext> made = TlsContext::forClient();
  return made;
}

}  // namespace

TcpStreamOpener::TcpStreamOpener(asio::io_context& context, ServerAddress address, ServerTrust trust,
                                 std::optional<ProxyOptions> proxy)
    : m_address(std::move(address)),
      m_trust(std::move(trust)),
      m_context(context),
      m_proxy(std::move(proxy)),
      m_connector(context, TcpOptions{.receive_limit = kMaxServerFrame},
                  m_trust.insecure ? nullptr : clientContext()),
      m_second_connector(context, TcpOptions{.receive_limit = kMaxServerFrame}, clientContext()) {}

void TcpStreamOpener::open(Done done) {
  connect(m_connector,
          [this, done = std::move(done)](std::unique_ptr<ReliableChannel> channel, const std::string& error) {
            if (channel) m_peer = endpointAddress(channel->peerAddress());
            done(std::move(channel), error);
          });
}

StreamOpener::RedirectTarget TcpStreamOpener::follow(const std::string& link) {
  const bool may = !m_trust.ignore_redirects && !m_trust.insecure && !m_proxy && m_peer;
  const auto parsed = JoinLink::parse(link);
  const auto* const p_link = std::get_if<JoinLink>(&parsed);
  if (!may || p_link == nullptr || !p_link->room.empty() || p_link->address.port < kMinRedirectPort)
    return {};
  ServerTrust trust;
  trust.link_key = p_link->key;
  trust.known_servers = m_trust.known_servers;
  trust.pin_new_keys = false;
  trust.ignore_redirects = true;
  const ServerAddress address{p_link->address.host, p_link->address.port};
  auto opener = std::make_unique<TcpStreamOpener>(m_context, address, std::move(trust), std::nullopt);
  const auto is_allowed = [from = *m_peer](const asio::ip::address& to) { return mayRedirectTo(from, to); };
  opener->m_connector.restrict(is_allowed);
  opener->m_second_connector.restrict(is_allowed);
  std::random_device random;
  std::uniform_int_distribution<int> wait(0, static_cast<int>(m_trust.max_redirect_wait.count()));
  return {std::move(opener), address, std::chrono::milliseconds(wait(random))};
}

void TcpStreamOpener::connect(TcpConnector& connector, Done done) {
  if (!m_proxy) return connector.connect(m_address.host, m_address.port, kConnectTimeout, std::move(done));
  connector.connectFor(m_proxy->visitor, m_proxy->socket, m_address.host, m_address.port, kConnectTimeout,
                       std::move(done));
}

void TcpStreamOpener::cancel() {
  m_connector.cancel();
  m_second_connector.cancel();
}

std::optional<Fingerprint> TcpStreamOpener::keyOf(const TcpConnector& connector) {
  const auto& facts = connector.peerIdentity();
  return facts ? std::optional(facts->key) : std::nullopt;
}

std::string TcpStreamOpener::trustError() const {
  if (m_trust.insecure || !m_connector.peerIdentity()) return {};
  try {
    const KnownServers known(m_trust.known_servers.empty() ? KnownServers::defaultPath()
                                                           : m_trust.known_servers);
    const PeerIdentity& facts = *m_connector.peerIdentity();
    const auto judgement = m_trust.pin_new_keys ? &KnownServers::admit : &KnownServers::verify;
    const TrustResult verdict =
        (known.*judgement)(m_address.host, m_address.port, facts, m_trust.fingerprint, m_trust.link_key);
    return verdict.accepted() ? std::string() : verdict.message;
  } catch (const KnownServersError& error) {
    return error.what();
  }
}

}  // namespace naiad
