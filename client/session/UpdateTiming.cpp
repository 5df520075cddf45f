#include "client/session/UpdateTiming.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace naiad {
namespace {

constexpr std::size_t kMaxPings = 20;  ///< maximum number of stored unanswered pings

}  // namespace

void StreamLiveness::startStream(Time now) {
  forgetPings();
  m_last_ping = now - kSlowPingInterval;
}

bool StreamLiveness::isStreamDead(Time now, bool has_datagrams) const {
  return has_datagrams && !m_pings.empty() && now - m_pings.begin()->second >= kStreamTimeout;
}

bool StreamLiveness::isPingDue(Time now, bool has_datagrams) const {
  const bool seldom = has_datagrams && m_stats.smoothed().count() > 0;
  return now - m_last_ping >= (seldom ? kSlowPingInterval : kPingInterval);
}

std::uint64_t StreamLiveness::startPing(Time now) {
  m_last_ping = now;
  if (m_pings.size() >= kMaxPings) m_pings.erase(m_pings.begin());
  m_pings.emplace(m_next_token, now);
  return m_next_token++;
}

std::optional<StreamLiveness::Millis> StreamLiveness::endPing(std::uint64_t token, Time now) {
  const auto ping = m_pings.find(token);
  if (ping == m_pings.end()) return std::nullopt;
  const Millis sample = now - ping->second;
  m_pings.erase(m_pings.begin(), std::next(ping));
  m_stats.addSample(sample, now);
  return sample;
}

std::chrono::milliseconds StreamLiveness::roundTrip() const {
  const auto whole = std::chrono::ceil<std::chrono::milliseconds>(m_stats.smoothed());
  return std::min<std::chrono::milliseconds>(whole, std::chrono::milliseconds(99999));
}

bool UpdateTiming::onDatagramSent(Time now) {
  m_probe.probeSent(now);
  if (now - m_last_ping < kDatagramPingInterval) return false;
  m_last_ping = now;
  return true;
}

void UpdateTiming::onUpdateSent() {
  m_unacknowledged = 0;
  m_acknowledge_at.reset();
}

bool UpdateTiming::onSnapshotApplied(bool gap, Time now) {
  ++m_unacknowledged;
  if (m_unacknowledged >= kSnapshotsPerAck || gap) return true;
  m_acknowledge_at = now + kAckDelay;
  return false;
}

bool UpdateTiming::popInputResend(Time now) {
  if (!m_resend_at || now < *m_resend_at) return false;
  m_resend_at.reset();
  return true;
}

std::optional<UpdateTiming::Time> UpdateTiming::nextWake() const {
  if (!m_resend_at || !m_acknowledge_at) return m_resend_at ? m_resend_at : m_acknowledge_at;
  return std::min(*m_resend_at, *m_acknowledge_at);
}

}  // namespace naiad
