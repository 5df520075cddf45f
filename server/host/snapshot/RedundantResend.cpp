#include "host/snapshot/RedundantResend.h"

#include <algorithm>

namespace naiad {

void RedundantResend::consider(const KnownObjects::Sent& sent, std::size_t bits, double urgency) {
  const auto again = std::find_if(m_present.begin(), m_present.end(),
                                  [&sent](const Record& record) { return record.sent.id == sent.id; });
  const int repeats = again != m_present.end() ? again->repeats + 1 : 0;
  if (repeats > 1 || (repeats == 1 && bits > kShortBits)) return;
  m_next.push_back({urgency, bits, sent, repeats});
}

void RedundantResend::owe(KnownObjects& known, std::uint32_t tick) {
  std::sort(m_next.begin(), m_next.end(), [](const Record& a, const Record& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.sent.id < b.sent.id;
  });
  m_present.clear();
  std::size_t spent = 0;
  for (const Record& record : m_next) {
    const KnownObjects::Sent& sent = record.sent;
    const KnownObjects::Known& now = known.at(sent.id);
    if (now.birth != sent.birth || now.unconfirmed == 0) continue;
    if (spent > 0 && spent + record.bits > kBits) continue;
    spent += record.bits;
    known.owe(sent.id, now.unconfirmed & (sent.groups == kDeath ? +kLife : +sent.groups), tick);
    m_present.push_back(record);
  }
  m_next.clear();
}

}  // namespace naiad
