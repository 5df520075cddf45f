#include "host/snapshot/SnapshotSender.h"

#include <algorithm>
#include <utility>

namespace naiad {

namespace {

/// Redundancy is off if the usual loss (0 … 1) is at most this.
constexpr double kMinLossForRedundancy = 0.003;

}  // namespace

void SnapshotSender::applyTick(const Publisher& publisher, const df::PlayerFacts& player) {
  m_tick = publisher.tick();
  m_replica.state.applyTick(publisher, player);
  if (!m_has_ticks) m_last_tick = m_tick - kKeepAlive;
  m_has_ticks = true;
  m_interest.update(publisher,
                    {m_viewport.update(publisher, player, m_look_ahead),
                     {player.followed, player.steering.object},
                     m_look_ahead,
                     player.id},
                    m_replica.objects);
}

// ---- building ---------------------------------------------------------------------------------------------

void SnapshotSender::build(const Publisher& publisher, PacketLimits limits, Packets& packets) {
  packets.clear();
  queueRecords(publisher);
  const bool due = isKeepAliveDue();
  m_throttled = m_replica.hasPending();
  if (!m_throttled && !due) return;
  // If the window is full, only a keep-alive is sent: each further snapshot makes the oldest count as lost.
  const std::size_t window = m_in_flight.size() < kMaxInFlight ? kMaxInFlight - m_in_flight.size()
                             : due                             ? 1
                                                               : 0;
  limits.packets = std::min(limits.packets, window);
  if (limits.packets > 0) SnapshotBuilder::ofThread().queueObjects(m_replica, publisher, limits.bytes);

  bool more = true;
  while (packets.size() < limits.packets && more && (m_replica.hasPending() || (due && packets.empty()))) {
    more = writeSnapshot(publisher, limits, packets.add());
    limits.large = limits.large && !packets.back().large;
    if (more || (due && packets.size() == 1)) continue;
    removeNewest();
    packets.removeLast();
  }
  m_throttled = m_replica.hasPending();
  if (!packets.empty()) m_last_tick = m_tick;
}

// Queues pending repeats and corrections; applyTick() has already queued the changes of objects.
void SnapshotSender::queueRecords(const Publisher& publisher) {
  if (m_resend == Resend::kEveryTick) m_replica.objects.requeueUnconfirmed(m_tick);
  m_replica.state.queueRepeats();
  m_redundancy.requeueRecords(m_replica.objects, m_tick);
  m_replica.objects.trimPending();
  m_replica.state.queueCorrections(publisher, m_replica.objects);
}

bool SnapshotSender::isKeepAliveDue() const {
  return static_cast<std::int32_t>(m_tick - m_last_tick) >= static_cast<std::int32_t>(kKeepAlive);
}

// Fills one snapshot. False if it carries nothing; then another one would not either.
bool SnapshotSender::writeSnapshot(const Publisher& publisher, const PacketLimits& limits, Packet& packet) {
  InFlightSnapshots::Snapshot& flight = m_in_flight.add(m_next_number);
  SnapshotBuilder& builder = SnapshotBuilder::ofThread();
  SnapshotHeader header{m_next_number, m_tick, m_epoch, false, false, 0, 0};
  m_replica.state.writeInput(header);
  builder.beginSnapshot(header, m_replica, flight, redundancy());
  builder.writeState(limits.bytes);
  builder.writeObjects(publisher, limits);
  packet.large = flight.large;
  const bool carries = !flight.empty;
  if (!m_replica.hasPending()) m_checksums.recordComplete(m_next_number);
  finishSnapshot(packet);
  return carries;
}

void SnapshotSender::finishSnapshot(Packet& packet) {
  packet.number = m_next_number;
  packet.tick = m_tick;
  SnapshotBuilder::ofThread().finish(!m_replica.hasPending(), packet.bytes);
  m_checksums.recordSent(m_next_number, m_replica.objects.checksum());
  if (++m_next_number == 0) m_next_number = 1;
  settleOldest();
}

void SnapshotSender::settleOldest() {
  if (m_in_flight.size() <= kMaxInFlight) return;
  bool oldest = true;
  m_in_flight.removeIf([&](const InFlightSnapshots::Snapshot& snapshot) {
    if (!std::exchange(oldest, false)) return false;
    requeueLost(snapshot);
    return true;
  });
}

// Withdraws the snapshot just written, which carries nothing.
void SnapshotSender::removeNewest() {
  m_next_number = m_in_flight.newest().number;
  m_in_flight.removeNewest();
  m_checksums.removeNewest(m_next_number);
}

SnapshotSender::Packet SnapshotSender::probe(const Publisher& publisher) {
  m_tick = publisher.tick();
  InFlightSnapshots::Snapshot& flight = m_in_flight.add(m_next_number);
  flight.probe = true;
  SnapshotBuilder::ofThread().beginSnapshot({m_next_number, m_tick, m_epoch, false, false, 0, 0}, m_replica,
                                            flight);
  Packet packet;
  finishSnapshot(packet);
  return packet;
}

RedundantResend* SnapshotSender::redundancy() {
  const bool lossy = m_losses.estimator().usualLoss() > kMinLossForRedundancy;
  return m_resend == Resend::kAhead && lossy ? &m_redundancy : nullptr;
}

// ---- acknowledgements -------------------------------------------------------------------------------------

void SnapshotSender::acknowledge(const AckWindow& acks) {
  // A number that was never sent is forged; accepting it would drop pending state.
  if (isNewer(acks.newest, m_next_number - 1)) return;
  m_in_flight.removeIf([&](const InFlightSnapshots::Snapshot& snapshot) {
    const bool arrived = acks.has(snapshot.number);
    if (!arrived && !m_losses.isLost(snapshot, acks)) return false;
    arrived ? m_replica.confirmArrival(snapshot) : requeueLost(snapshot);
    m_losses.recordOutcome(snapshot, !arrived);
    return true;
  });
  m_losses.recordLateArrivals(acks);
}

void SnapshotSender::requeueLost(const InFlightSnapshots::Snapshot& snapshot) {
  const ClientReplica::Requeued requeued = m_replica.requeueLost(snapshot, m_tick);
  m_resent += requeued.objects;
  // State that has changed or was removed since the snapshot was sent is already pending; until it is sent,
  // the client lacks the lost contents.
  const bool pending = requeued.any || (!snapshot.empty && m_replica.hasPending());
  m_checksums.recordLost(snapshot, pending, newestNumber());
}

void SnapshotSender::requeueLarge() {
  m_in_flight.removeIf([this](const InFlightSnapshots::Snapshot& snapshot) {
    if (snapshot.large) requeueLost(snapshot);
    return snapshot.large;
  });
}

void SnapshotSender::reset() {
  SnapshotSender next(m_resend);
  next.m_viewport = m_viewport;
  next.m_look_ahead = m_look_ahead;
  next.m_epoch = static_cast<std::uint8_t>((m_epoch + 1) & 3);
  next.m_next_number = m_next_number;
  next.m_checksums = SentChecksums(m_next_number);
  // Acknowledge the newest input again: a client that lacks the acknowledgement waits before it sends more.
  next.setNewestInput(m_replica.state.input(), m_replica.state.inputTick());
  *this = std::move(next);
}

}  // namespace naiad
