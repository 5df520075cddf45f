// A host's doors: where it listens, whom it lets that far, and how it is found there.
#include "host/admission/Places.h"
#include "host/loop/Host.h"
#include "host/world/Descendants.h"

namespace naiad {

TlsListening Host::listening() {
  TlsListening listening;
  if (!m_identity) return listening;
  listening.context = m_identity->tls();
  const HalfOpenPlaces half_open = halfOpenPlaces(m_options);
  listening.max_half_open = half_open.in_all;
  listening.max_half_open_known = half_open.known;
  listening.max_half_open_per_prefix = half_open.of_a_prefix;
  listening.is_known = [this](const AddressPrefix& prefix) { return m_prefixes.count(prefix) > 0; };
  listening.on_refused = [this](const auto& peer, StreamRefusal why) { m_stream_refusals.note(peer, why); };
  listening.is_banned = [this](const asio::ip::address& address) { return m_bans.isBanned(address); };
  listening.take_handshake = [this](const AddressPrefix& prefix) {
    return m_handshakes.take(prefix, Clock::now());
  };
  listening.has_handshake = [this](const AddressPrefix& prefix) {
    return m_handshakes.has(prefix, Clock::now());
  };
  return listening;
}

// A world may have this user's rights, and so those on the socket: it would be as many visitors as it likes.
VisitorsListening Host::visitors() const {
  VisitorsListening visitors;
  visitors.path = m_options.visitors;
  visitors.is_refused = [](pid_t process) { return isDescendant(process); };
  return visitors;
}

Listing::Server Host::listedAs(const std::string& game) const {
  const auto link = m_options.link_host.empty() ? std::nullopt : joinLink(true);
  return {game, m_network.port(), fingerprint(), link ? link->text() : std::string()};
}

std::optional<Fingerprint> Host::fingerprint() const {
  return m_identity ? std::optional(m_identity->fingerprint()) : std::nullopt;
}

std::string Host::joinArguments() const {
  const std::string port = std::to_string(m_network.port());
  const bool any = m_options.address == "::" || m_options.address == "0.0.0.0";
  const std::string where = any ? "127.0.0.1:" + port : m_network.address();
  return where + (m_identity ? " --fingerprint " + m_identity->fingerprint().text() : " --insecure");
}

std::optional<JoinLink> Host::joinLink(bool elsewhere) const {
  if (!m_identity) return std::nullopt;
  const bool any = m_options.address == "::" || m_options.address == "0.0.0.0";
  const std::uint16_t port = m_network.port();
  const auto where = elsewhere ? LinkHost::parse(m_options.link_host, port)
                     : any     ? LinkHost::parse("127.0.0.1", port)
                               : LinkHost::parse(m_network.address());
  if (!where) return std::nullopt;
  return JoinLink{*where, "", ShortKey::of(m_identity->fingerprint())};
}

}  // namespace naiad
