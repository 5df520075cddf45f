#include "host/snapshot/RedundantResend.h"

#include <algorithm>

namespace naiad {

void RedundantResend::addRecord(const KnownObjects::Sent& sent, std::size_t bits, double urgency) {
  const auto repeated = std::find_if(m_current.begin(), m_current.end(),
                                     [&sent](const Record& record) { return record.sent.id == sent.id; });
  const int repeats = repeated != m_current.end() ? repeated->repeats + 1 : 0;
  if (repeats > 1 || (repeats == 1 && bits > kShortBits)) return;
  m_next.push_back({urgency, bits, sent, repeats});
}

void RedundantResend::requeueRecords(KnownObjects& known, std::uint32_t tick) {
  std::sort(m_next.begin(), m_next.end(), [](const Record& a, const Record& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.sent.id < b.sent.id;
  });
  m_current.clear();
  std::size_t used = 0;
  for (const Record& record : m_next) {
    const KnownObjects::Sent& sent = record.sent;
    const KnownObjects::Known& now = known.at(sent.id);
    if (now.birth != sent.birth || now.unconfirmed == 0) continue;
    if (used > 0 && used + record.bits > kBits) continue;
    used += record.bits;
    known.addPending(sent.id, now.unconfirmed & (sent.groups == kDeath ? +kLife : +sent.groups), tick);
    m_current.push_back(record);
  }
  m_next.clear();
}

}  // namespace naiad
