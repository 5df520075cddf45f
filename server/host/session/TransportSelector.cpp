#include "host/session/TransportSelector.h"

#include <algorithm>
#include <bit>

namespace naiad {

namespace {

constexpr TransportSelector::Millis kFullQueue{50};
constexpr double kMuchLoss = 0.15;
constexpr std::chrono::seconds kBadFor{1};
constexpr std::chrono::seconds kGoodFor{5};

}  // namespace

void TransportSelector::noteSent(std::uint32_t number, bool as_datagram, Time now) {
  m_sent[number % kKept] = {number, as_datagram, true, false, now};
  if (as_datagram && !isOpen(now)) m_probe.probeSent(now);
}

// Most of a window was in the one before, which came by the same transport: only what is new in it counts.
void TransportSelector::acknowledge(const AckWindow& acks, bool by_datagram, Time now) {
  AckWindow& before = m_acked[by_datagram ? 1 : 0];
  const std::uint32_t ahead = acks.newest - before.newest;
  const bool follows = before.newest != 0 && !isNewer(before.newest, acks.newest) && ahead <= 64;
  std::uint64_t fresh = acks.mask;
  if (follows && ahead > 0)
    fresh &= ~((ahead < 64 ? before.mask << ahead : 0) | std::uint64_t{1} << (ahead - 1));
  if (follows && ahead == 0) fresh &= ~before.mask;
  if (before.newest == 0 || !isNewer(before.newest, acks.newest)) before = acks;
  noteArrival(acks.newest, true, by_datagram, now);
  for (; fresh != 0; fresh &= fresh - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(fresh));
    noteArrival(acks.newest - 1 - bit, false, by_datagram, now);
  }
}

void TransportSelector::noteArrival(std::uint32_t number, bool newest, bool by_datagram, Time now) {
  Sent& sent = m_sent[number % kKept];
  if (sent.number != number || number == 0) return;
  if (sent.open && newest) m_stats.addSample(now - sent.at, now);
  sent.open = false;
  if (!sent.as_datagram || !by_datagram || sent.confirmed) return;
  sent.confirmed = true;
  // What was sent before the line fell silent says nothing of it now.
  if (now - sent.at < 2 * PathProbe::kOpenFor) m_probe.addEvidence(now);
}

std::uint32_t TransportSelector::interval(double loss, Time now) {
  const bool bad = roundTrip() - shortestRoundTrip() > kFullQueue || loss > kMuchLoss;
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
