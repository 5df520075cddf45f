// Sends one client's snapshots: as datagrams where datagrams pass, otherwise on the streams.
//
// Acknowledgements, checksums and reset requests arrive on these transports.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/net/SealedChannel.h"
#include "host/session/Counters.h"
#include "host/session/ReplicaAudit.h"
#include "host/session/StreamPair.h"
#include "host/session/TransportSelector.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/SnapshotSender.h"

namespace naiad {

class SnapshotDelivery {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kResetInterval{2};
  /// Minimum time between two checksums. Clients send one a second; a few may arrive together after a stall.
  static constexpr std::chrono::milliseconds kChecksumInterval{250};
  /// Number of bytes: larger snapshots use the first stream only. Changes that gathered during a wait are
  /// small enough to send twice; a whole world would be too much for a slow connection.
  static constexpr std::size_t kMaxOnSecond = std::size_t{4} * 1024;

  SnapshotDelivery(Counters& counters, Time now) : m_counters(counters), m_transport(now) {}

  /// Sets the datagram channel; null: snapshots use the streams only.
  void setDatagrams(std::unique_ptr<SealedChannel> datagrams) { m_datagrams = std::move(datagrams); }
  SealedChannel* datagrams() { return m_datagrams.get(); }

  /// Sends the published tick's pending changes, unless the client or connection is busy with earlier bytes.
  void sendTick(const Publisher& publisher, const df::PlayerFacts& player, StreamPair& streams, Time now);
  /// Sets the newest input that the world has applied, and the tick in which it did.
  void setNewestInput(std::uint32_t id, std::uint32_t tick) { m_sender.setNewestInput(id, tick); }
  void setTerminal(std::uint32_t columns, std::uint32_t rows) { m_sender.setTerminal(columns, rows); }

  /// Starts or stops the audit of the client's pictures (ReplicaAudit.h).
  void setAudit(bool audit);
  /// Returns null if there is no audit.
  ReplicaAudit* audit() { return m_audit.get(); }

  void acknowledge(const AckWindow& acks, bool by_datagram, Time now);
  /// Resets the client's world (requestReset()) if the checksum does not match the sent snapshots. Ignores a
  /// checksum less than kChecksumInterval after the last one.
  void compareChecksum(const AckWindow& acks, std::uint64_t checksum, Time now);
  /// Sends the client's world again, at most once per kResetInterval.
  void requestReset(Time now);

  /// Makes everything pending again, because the client starts from an empty world.
  void reset();
  /// Call when the first stream broke: the contents of large snapshots in flight are pending again.
  void onStreamLost();
  /// Call when the client is on another stream: probes again whether datagrams pass.
  void renewTransport(Time now) { m_transport.renew(now); }
  /// Call when another process of the client has resumed the session: forgets the transport state and sends
  /// the world, like a reset.
  void restart(Time now);

  /// True if earlier unsent bytes delayed the last snapshot, which was to use a stream.
  bool isBlocked() const { return m_blocked; }
  bool usesDatagrams(Time now) const { return m_datagrams != nullptr && m_transport.isOpen(now); }
  /// The newest published tick.
  std::uint32_t tick() const { return m_tick; }
  /// The tick of a snapshot; nullopt if it is no longer remembered.
  std::optional<std::uint32_t> tickOf(std::uint32_t snapshot) const { return m_ticks.tickOf(snapshot); }
  /// Ticks after which the client was not up to date: it or its connection was busy with earlier bytes.
  std::uint64_t skippedTicks() const { return m_skipped_ticks; }
  const TransportSelector& transport() const { return m_transport; }
  const SnapshotSender& sender() const { return m_sender; }

 private:
  void applyWaitingAck();
  void sendDatagrams(const Publisher& publisher, StreamPair& streams, Time now);
  void sendOnStreams(const Publisher& publisher, StreamPair& streams, Time now);
  void sendProbe(const Publisher& publisher, Time now);
  void markSent(const SnapshotSender::Packet& packet, bool as_datagram, Time now);
  void count(const SnapshotSender::Packet& packet);
  void countDatagram(const SnapshotSender::Packet& packet);
  void skipTick();

  Counters& m_counters;
  std::unique_ptr<SealedChannel> m_datagrams;
  std::uint32_t m_tick = 0;
  std::optional<AckWindow> m_acks;  ///< received acknowledgement, not passed to m_sender yet
  std::uint64_t m_skipped_ticks = 0;
  SnapshotSender m_sender{Resend::kAhead};
  std::unique_ptr<ReplicaAudit> m_audit;
  TransportSelector m_transport;
  SnapshotTicks m_ticks;
  bool m_blocked = false;
  std::optional<Time> m_last_reset;
  std::optional<Time> m_last_checksum;
};

}  // namespace naiad
