#include "client/session/UpdateTiming.h"

#include <algorithm>

namespace naiad {

bool UpdateTiming::noteDatagramSent(Time now) {
  m_probe.probeSent(now);
  if (now - m_last_ping < kPingEvery) return false;
  m_last_ping = now;
  return true;
}

void UpdateTiming::noteUpdateSent() {
  m_unacknowledged = 0;
  m_acknowledge_at.reset();
}

bool UpdateTiming::noteSnapshotApplied(bool gap, Time now) {
  ++m_unacknowledged;
  if (m_unacknowledged >= kAckEvery || gap) return true;
  m_acknowledge_at = now + kAckDelay;
  return false;
}

bool UpdateTiming::takeRepeat(Time now) {
  if (!m_repeat_at || now < *m_repeat_at) return false;
  m_repeat_at.reset();
  return true;
}

std::optional<UpdateTiming::Time> UpdateTiming::nextWake() const {
  if (!m_repeat_at || !m_acknowledge_at) return m_repeat_at ? m_repeat_at : m_acknowledge_at;
  return std::min(*m_repeat_at, *m_acknowledge_at);
}

}  // namespace naiad
