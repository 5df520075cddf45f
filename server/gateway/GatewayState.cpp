#include "server/gateway/GatewayState.h"

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kStreamsPerPlayer = 2;
constexpr std::size_t kMaxShownName = 100;  // characters

/// Rates of new connections. A page has about ten files, for which a browser opens six connections. The burst
/// allows a class to open the page at once; then 16 connections a second are allowed from one address.
constexpr PrefixRateLimiter::Rates kArrivals{{16, 1024}, {64, 4096}, std::nullopt};

std::string serverJson(const GatewaySettings& settings) {
  const std::string name = settings.name.empty() ? settings.link->address.host : settings.name;
  return "{\"name\": " + Json(safeText(name, kMaxShownName)).toString() +
         ", \"key\": " + Json(settings.link->key.text()).toString() + "}\n";
}

}  // namespace

PendingConnections::Slot::~Slot() {
  if (!m_owner) return;
  m_owner->m_limit.release(m_id);
  m_owner->m_disconnects.erase(m_id);
}

bool PendingConnections::Slot::setBusy() {
  return m_owner->m_limit.onHello(m_id);
}

void PendingConnections::Slot::setSilent() {
  Disconnect disconnect = std::move(m_owner->m_disconnects.at(m_id));
  m_owner->m_disconnects.erase(m_id);
  m_owner->m_limit.release(m_id);
  m_id = m_owner->admit(m_prefix, std::move(disconnect));
}

PendingConnections::Slot PendingConnections::acquire(const AddressPrefix& prefix, Disconnect disconnect) {
  using Kind = HalfOpenLimit::Result::Kind;
  for (auto verdict = m_limit.check(prefix); verdict.kind != Kind::kFits; verdict = m_limit.check(prefix)) {
    if (verdict.kind != Kind::kEvictFirst) return {};
    ++m_evicted;
    const Disconnect end = m_disconnects.at(verdict.id);  // a copy, because the call erases it
    end();
  }
  return {*this, admit(prefix, std::move(disconnect)), prefix};
}

HalfOpenLimit::Id PendingConnections::admit(const AddressPrefix& prefix, Disconnect disconnect) {
  m_limit.admit(++m_newest, prefix);
  m_disconnects[m_newest] = std::move(disconnect);
  return m_newest;
}

GatewayState::GatewayState(GatewaySettings given, const AllowedOrigins& allowed, LogLine line)
    : settings(std::move(given)),
      origins(allowed),
      page(settings.page),
      responses(page, origins, serverJson(settings), !settings.certificate.empty()),
      server{settings.visitors, settings.link->key, TlsContext::forClient()},
      log(std::move(line)),
      arrivals(kArrivals),
      pending({settings.max_pending, settings.max_pending_per_address}),
      places(kStreamsPerPlayer * settings.max_visitors, kStreamsPerPlayer * settings.max_per_address) {}

}  // namespace naiad
