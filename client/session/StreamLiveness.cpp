#include "client/session/StreamLiveness.h"

namespace naiad {

void StreamLiveness::startStream(Time now) {
  m_round_trip.forgetPings();
  m_last_ping = now - kSeldomPing;
}

bool StreamLiveness::isStreamDead(Time now, bool has_datagrams) const {
  return has_datagrams && m_round_trip.waiting(now) >= kStreamSilence;
}

bool StreamLiveness::isPingDue(Time now, bool has_datagrams) const {
  const bool seldom = has_datagrams && m_round_trip.smoothed().count() > 0;
  return now - m_last_ping >= (seldom ? kSeldomPing : kPingInterval);
}

std::uint64_t StreamLiveness::startPing(Time now) {
  m_last_ping = now;
  return m_round_trip.startPing(now);
}

}  // namespace naiad
