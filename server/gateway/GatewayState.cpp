#include "server/gateway/GatewayState.h"

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kStreamsOfAPlayer = 2;
constexpr std::size_t kMaxShownName = 100;  // characters

/// A page has some ten files, for which browsers open six connections. The burst allows a class to open it at
/// once; then 16 connections a second are allowed from one address.
constexpr PrefixAllowance::Rates kArrivals{{16, 1024}, {64, 4096}, std::nullopt};

std::string serverJson(const GatewaySettings& settings) {
  const std::string name = settings.name.empty() ? settings.link->where.host : settings.name;
  return "{\"name\": " + Json(safeText(name, kMaxShownName)).toString() +
         ", \"key\": " + Json(settings.link->key.text()).toString() + "}\n";
}

}  // namespace

Newcomers::Place::~Place() {
  if (!m_owner) return;
  m_owner->m_limit.release(m_id);
  m_owner->m_hang_ups.erase(m_id);
}

bool Newcomers::Place::setBusy() {
  return m_owner->m_limit.noteHello(m_id);
}

void Newcomers::Place::setSilent() {
  HangUp hang_up = std::move(m_owner->m_hang_ups.at(m_id));
  m_owner->m_hang_ups.erase(m_id);
  m_owner->m_limit.release(m_id);
  m_id = m_owner->admit(m_prefix, std::move(hang_up));
}

Newcomers::Place Newcomers::take(const AddressPrefix& prefix, HangUp hang_up) {
  using Kind = HalfOpenLimit::Verdict::Kind;
  for (auto verdict = m_limit.judge(prefix); verdict.kind != Kind::kFits; verdict = m_limit.judge(prefix)) {
    if (verdict.kind != Kind::kEndFirst) return {};
    ++m_ended;
    const HangUp end = m_hang_ups.at(verdict.id);  // a copy, because the call erases it
    end();
  }
  return {*this, admit(prefix, std::move(hang_up)), prefix};
}

HalfOpenLimit::Id Newcomers::admit(const AddressPrefix& prefix, HangUp hang_up) {
  m_limit.admit(++m_newest, prefix);
  m_hang_ups[m_newest] = std::move(hang_up);
  return m_newest;
}

GatewayState::GatewayState(GatewaySettings given, const AllowedNames& allowed, LogLine line)
    : settings(std::move(given)),
      names(allowed),
      page(settings.page),
      answers(page, names, serverJson(settings), !settings.certificate.empty()),
      server{settings.visitors, settings.link->key, TlsContext::forClient()},
      log(std::move(line)),
      arrivals(kArrivals),
      newcomers({settings.max_newcomers, settings.max_newcomers_per_address}),
      places(kStreamsOfAPlayer * settings.max_visitors, kStreamsOfAPlayer * settings.max_per_address) {}

}  // namespace naiad
