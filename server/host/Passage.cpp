#include "Passage.h"

#include <algorithm>

namespace naiad {

namespace {

constexpr std::chrono::seconds kShortestAge{5};  ///< two of these are kept
constexpr Passage::Millis kFullQueue{50};
constexpr double kMuchLoss = 0.15;
constexpr std::chrono::seconds kBadFor{1};
constexpr std::chrono::seconds kGoodFor{5};

}  // namespace

void Passage::sent(std::uint32_t number, bool as_datagram, Time now) {
  m_sent[number % kKept] = {number, as_datagram, true, false, now};
  if (as_datagram && !isOpen(now)) m_last_probe = now;
}

void Passage::acknowledged(const AckWindow& acks, bool by_datagram, Time now) {
  for (Sent& sent : m_sent) {
    if (sent.number == 0 || !acks.has(sent.number)) continue;
    if (sent.open && sent.number == acks.newest) measure(now - sent.at, now);
    sent.open = false;
    if (!sent.as_datagram || !by_datagram || sent.confirmed) continue;
    sent.confirmed = true;
    // What was sent before the line fell silent says nothing of it now.
    if (now - sent.at < kSilence + kSilence) {
      m_open = true;
      m_last_ack = now;
    }
  }
}

void Passage::measure(Millis sample, Time now) {
  m_round_trip = m_round_trip.count() == 0 ? sample : m_round_trip + (sample - m_round_trip) / 8;
  if (now - m_shortest_since >= kShortestAge) {
    m_shortest_before = m_shortest;
    m_shortest = sample;
    m_shortest_since = now;
  }
  m_shortest = std::min(m_shortest, sample);
}

std::uint32_t Passage::interval(double loss, Time now) {
  const bool bad = m_round_trip - shortestRoundTrip() > kFullQueue || loss > kMuchLoss;
  if (bad != m_bad) (bad ? m_bad_since : m_good_since) = now;
  m_bad = bad;
  if (bad && now - m_bad_since >= kBadFor && m_rung + 1 < kIntervals.size()) {
    ++m_rung;
    m_bad_since = now;
  }
  if (!bad && now - m_good_since >= kGoodFor && m_rung > 0) {
    --m_rung;
    m_good_since = now;
  }
  return kIntervals[m_rung];
}

}  // namespace naiad
