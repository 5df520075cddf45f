#include "shared/program/ClientLog.h"

#include <utility>

#include "shared/net/base/AddressPrefix.h"
#include "shared/program/LogText.h"

namespace naiad {

namespace {

constexpr std::size_t kPrefixes = 1024;  ///< number of remembered address prefixes

}  // namespace

ClientLog::ClientLog(LogLine log)
    : m_log(std::move(log)),
      m_events{"lines about players", kEventRatePerPrefix, kTotalEventRate,
               PrefixLruMap<TokenBucket>(kPrefixes)},
      m_refusals{"refusals", kRefusalRatePerPrefix, kTotalRefusalRate, PrefixLruMap<TokenBucket>(kPrefixes)} {
}

void ClientLog::logClientEvent(const std::string& address, LogEvent event, Time now) {
  event.text.insert(0, address + " ");
  log(m_events, address, std::move(event), now);
}

void ClientLog::logRefusal(const std::string& address, const std::string& sentence, Time now) {
  log(m_refusals, address, {"refused", address + " refused: " + inQuotes(sentence), {{"sentence", sentence}}},
      now);
}

void ClientLog::log(Kind& kind, const std::string& address, LogEvent event, Time now) {
  const auto prefix = AddressPrefix::ofEndpoint(address).value_or(AddressPrefix());
  // Checks the prefix's limit first, so that a prefix over its limit uses no tokens of the others.
  if (kind.prefixes.use(prefix).tryConsume(kind.per_prefix, now) && kind.all.tryConsume(kind.total, now)) {
    event.fields.insert(event.fields.begin(), {"address", address});
    return m_log(event);
  }
  if (kind.suppressed++ == 0) kind.counted_at = now;
}

void ClientLog::update(Time now) {
  for (Kind* p_kind : {&m_events, &m_refusals}) {
    if (p_kind->suppressed > 0 && now - p_kind->counted_at >= kCountInterval) logCount(*p_kind);
  }
}

void ClientLog::finish() {
  logCount(m_events);
  logCount(m_refusals);
}

void ClientLog::logCount(Kind& kind) {
  if (kind.suppressed == 0) return;
  m_log(std::to_string(std::exchange(kind.suppressed, 0)) + " more " + kind.name + " were not logged");
}

}  // namespace naiad
