#include "host/session/SnapshotDelivery.h"

#include <algorithm>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"

namespace naiad {

namespace {

constexpr PacketLimits kStreamRoom{64, kMaxSnapshot, false};
constexpr PacketLimits kSecondRoom{1, SnapshotDelivery::kMaxOnSecond, false};
/// Maximum number of datagrams per tick: more than a megabit per second at 30 Hz.
constexpr std::size_t kDatagramsPerTick = 4;

/// The sessions of a thread send one after the other, so they share one buffer.
SnapshotSender::Packets& packetsOfThread() {
  thread_local SnapshotSender::Packets packets;
  return packets;
}

std::string frameOf(const SnapshotSender::Packet& packet) {
  wire::ServerMessage message;
  message.set_snapshot(packet.bytes);
  return message.SerializeAsString();
}

}  // namespace

void SnapshotDelivery::sendTick(const Publisher& publisher, const df::PlayerFacts& player,
                                StreamPair& streams, Time now) {
  m_tick = publisher.tick();
  m_blocked = false;
  applyWaitingAck();
  m_sender.applyTick(publisher, player);
  if (m_audit) m_audit->beginTick(m_sender.newestNumber(), m_tick);
  if (usesDatagrams(now)) return sendDatagrams(publisher, streams, now);
  if (m_datagrams != nullptr && m_datagrams->payloadBudget() &&
      m_transport.wantsProbe(now, streams.first() == nullptr)) {
    sendProbe(publisher, now);
  }
  sendOnStreams(publisher, streams, now);
}

void SnapshotDelivery::sendProbe(const Publisher& publisher, Time now) {
  const SnapshotSender::Packet probe = m_sender.probe(publisher);
  markSent(probe, true, now);
  m_datagrams->send(probe.bytes);
}

void SnapshotDelivery::sendDatagrams(const Publisher& publisher, StreamPair& streams, Time now) {
  const std::uint32_t interval = m_transport.interval(m_sender.loss(), now);
  const auto payload_budget = m_datagrams->payloadBudget();
  if (publisher.tick() % interval != 0 || !payload_budget) return skipTick();
  const std::size_t bytes = std::min(*payload_budget, kMaxDatagramSnapshot);
  SnapshotSender::Packets& packets = packetsOfThread();
  m_sender.build(publisher, {kDatagramsPerTick, bytes, streams.isFirstIdle()}, packets);
  for (const SnapshotSender::Packet& packet : packets) {
    markSent(packet, !packet.large, now);
    count(packet);
    if (!packet.large) countDatagram(packet);
    packet.large ? streams.sendFirst(frameOf(packet)) : m_datagrams->send(packet.bytes);
  }
  if (m_sender.isThrottled()) skipTick();
}

void SnapshotDelivery::sendOnStreams(const Publisher& publisher, StreamPair& streams, Time now) {
  if (streams.first() == nullptr) return;
  // While the first stream waits for a retransmission, the second one continues alone. A large snapshot
  // uses the first stream, and nothing may overtake it.
  const bool first = streams.isFirstIdle();
  const bool second = streams.isSecondIdle() && !m_sender.hasLargeInFlight();
  m_blocked = !first && !second;
  if (m_blocked) return skipTick();
  SnapshotSender::Packets& packets = packetsOfThread();
  m_sender.build(publisher, first ? kStreamRoom : kSecondRoom, packets);
  const bool small = packets.size() == 1 && packets.back().bytes.size() <= kMaxOnSecond;
  for (const SnapshotSender::Packet& packet : packets) {
    markSent(packet, false, now);
    count(packet);
    const std::string frame = frameOf(packet);
    if (first) streams.sendFirst(frame);
    if (second && small) streams.sendSecond(frame);
    if (streams.hasSecond() && !small) m_sender.markLarge(packet.number);
  }
  if (m_sender.isThrottled()) skipTick();
}

void SnapshotDelivery::markSent(const SnapshotSender::Packet& packet, bool as_datagram, Time now) {
  if (m_audit) m_audit->recordSent(packet);
  m_transport.markSent(packet.number, as_datagram, now);
  m_ticks.recordSent(packet.number, packet.tick);
}

void SnapshotDelivery::count(const SnapshotSender::Packet& packet) {
  ++m_counters.snapshots;
  m_counters.snapshot_bytes += packet.bytes.size();
}

void SnapshotDelivery::countDatagram(const SnapshotSender::Packet& packet) {
  ++m_counters.datagram_snapshots;
  m_counters.datagram_snapshot_bytes += packet.bytes.size();
}

void SnapshotDelivery::skipTick() {
  ++m_skipped_ticks;
  ++m_counters.skipped_ticks;
}

void SnapshotDelivery::acknowledge(const AckWindow& acks, bool by_datagram, Time now) {
  applyWaitingAck();
  m_acks = acks;
  m_transport.acknowledge(acks, by_datagram, now);
}

// An acknowledgement usually waits for the next sendTick(), which touches the memory that it needs anyway.
void SnapshotDelivery::applyWaitingAck() {
  if (m_acks) m_sender.acknowledge(*m_acks);
  if (m_acks && m_audit) m_audit->acknowledge(*m_acks, m_sender);
  m_acks.reset();
}

void SnapshotDelivery::compareChecksum(const AckWindow& acks, std::uint64_t checksum, Time now) {
  if (m_last_checksum && now - *m_last_checksum < kChecksumInterval) {
    ++m_counters.checksums_dropped;
    return;
  }
  m_last_checksum = now;
  applyWaitingAck();
  if (m_sender.matchesChecksum(acks, checksum) != false) return;
  ++m_counters.divergences;
  requestReset(now);
}

void SnapshotDelivery::requestReset(Time now) {
  if (m_last_reset && now - *m_last_reset < kResetInterval) {
    ++m_counters.resets_dropped;
    return;
  }
  m_last_reset = now;
  ++m_counters.resets;
  reset();
}

void SnapshotDelivery::reset() {
  m_acks.reset();
  m_sender.reset();
  if (m_audit) m_audit->restart();
}

// If no snapshot was sent yet, the audit starts now, because the first ones send the whole world.
void SnapshotDelivery::setAudit(bool audit) {
  m_audit = audit ? std::make_unique<ReplicaAudit>(m_counters) : nullptr;
  if (m_audit && m_sender.newestNumber() == 0) m_audit->restart();
}

void SnapshotDelivery::onStreamLost() {
  m_blocked = false;
  applyWaitingAck();
  m_sender.requeueLarge();
}

void SnapshotDelivery::restart(Time now) {
  m_blocked = false;
  m_last_reset = now;
  reset();
  m_transport = TransportSelector(now);
}

}  // namespace naiad
