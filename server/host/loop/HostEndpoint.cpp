#include "host/loop/HostEndpoint.h"

#include <asio/post.hpp>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include "host/admission/CapacityLimits.h"
#include "host/world/Descendants.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/ByteStream.h"

namespace naiad {

namespace {

/// Returns the reason for the log. The client is disconnected without an answer.
std::string sentenceOf(StreamRefusal why) {
  switch (why) {
    case StreamRefusal::kBanned:
      return "This address is banned.";
    case StreamRefusal::kTooOften:
      return "Too many connections from this network.";
    case StreamRefusal::kPrefixFull:
      return "Too many unfinished connections from this network.";
    case StreamRefusal::kFull:
      return "Too many unfinished connections.";
  }
  return "";
}

using Clock = std::chrono::steady_clock;

TcpOptions channelOptions() {
  TcpOptions options;
  options.receive_limit = kMaxHelloFrame;
  return options;
}

/// Returns the key and certificate for TLS; nullopt without encryption.
std::optional<ServerIdentity> identityOf(const HostOptions& options) {
  if (options.insecure) return std::nullopt;
  if (!options.certificate.empty()) return ServerIdentity::load(options.certificate, options.key);
  const auto directory =
      options.identity.empty() ? ServerIdentity::defaultDirectory() : std::filesystem::path(options.identity);
  return ServerIdentity::loadOrMake(directory, std::chrono::system_clock::now());
}

}  // namespace

void StreamRefusalLog::record(const asio::ip::tcp::endpoint& peer, StreamRefusal why) {
  const auto now = std::chrono::steady_clock::now();
  if (!m_limit.tryConsume(ClientLog::kTotalRefusalRate, now)) return;
  asio::post(m_home, [this, now, address = peerName(peer), sentence = sentenceOf(why)] {
    m_log.logRefusal(address, sentence, now);
  });
}

HostEndpoint::HostEndpoint(HostContext& context, TcpListener::OnChannel on_channel)
    : m_context(context),
      m_identity(identityOf(context.options)),
      m_handshakes(RateLimits::handshakes(context.options.max_per_address)),
      m_refusals(context.home, context.client_log),
      m_network(context.home, context.options.address, static_cast<std::uint16_t>(context.options.port),
                std::move(on_channel), channelOptions(), listening(), NetworkThread::Limits(), visitors(),
                context.options.sockets) {
  if (m_identity && !m_identity->warning().empty()) context.log(LogEvent::warning(m_identity->warning()));
}

TlsListenerOptions HostEndpoint::listening() {
  TlsListenerOptions listening;
  if (!m_identity) return listening;
  listening.context = m_identity->tls();
  const HalfOpenQuota half_open = halfOpenQuota(m_context.options);
  listening.max_half_open = half_open.total;
  listening.max_half_open_known = half_open.known;
  listening.max_half_open_per_prefix = half_open.per_prefix;
  listening.is_known = [this](const AddressPrefix& prefix) { return m_prefixes.count(prefix) > 0; };
  listening.on_refused = [this](const auto& peer, StreamRefusal why) { m_refusals.record(peer, why); };
  listening.is_banned = [this](const asio::ip::address& address) {
    return m_is_banned && m_is_banned(address);
  };
  listening.try_handshake = [this](const AddressPrefix& prefix) {
    return m_handshakes.tryConsume(prefix, Clock::now());
  };
  listening.can_handshake = [this](const AddressPrefix& prefix) {
    return m_handshakes.canConsume(prefix, Clock::now());
  };
  return listening;
}

// Refuses world processes, because they may open the socket with this user's rights and could state any
// address as a visitor's.
ProxyListenerOptions HostEndpoint::visitors() const {
  ProxyListenerOptions visitors;
  visitors.path = m_context.options.visitors;
  visitors.is_refused = [](pid_t process) { return isDescendant(process); };
  return visitors;
}

std::optional<Fingerprint> HostEndpoint::fingerprint() const {
  return m_identity ? std::optional(m_identity->fingerprint()) : std::nullopt;
}

bool HostEndpoint::listensOnAll() const {
  return m_context.options.address == "::" || m_context.options.address == "0.0.0.0";
}

std::string HostEndpoint::joinArguments() const {
  const std::string where = listensOnAll() ? "127.0.0.1:" + std::to_string(port()) : address();
  return where + (m_identity ? " --fingerprint " + m_identity->fingerprint().text() : " --insecure");
}

std::optional<JoinLink> HostEndpoint::joinLink(bool elsewhere) const {
  if (!m_identity) return std::nullopt;
  const auto where = elsewhere        ? LinkHost::parse(m_context.options.link_host, port())
                     : listensOnAll() ? LinkHost::parse("127.0.0.1", port())
                                      : LinkHost::parse(address());
  if (!where) return std::nullopt;
  return JoinLink{*where, "", ShortKey::of(m_identity->fingerprint())};
}

std::string HostEndpoint::joinCommand() const {
  const auto public_link = joinLink(true);
  const auto link = public_link ? public_link : joinLink(false);
  return "dfclient " + (link ? link->text() : joinArguments());
}

void HostEndpoint::setIdentity(ServerIdentity identity) {
  if (identity.fingerprint() != m_identity->fingerprint()) {
    m_context.log(LogEvent::warning(
        "the server's key has changed, so players with the old key see a warning. New key: " +
        identity.fingerprint().text()));
  }
  m_identity = std::move(identity);
  m_network.setTls(m_identity->tls());
}

}  // namespace naiad
