// One client's snapshots: what is pending is written, and sent again if it is lost.
//
// A client receives what it can see: objects in its view, objects that are about to enter it, and the object
// that the view follows. In each tick Interest decides which objects the client knows, SnapshotBuilder writes
// what is pending in ClientReplica, most urgent first, and acknowledgements settle the snapshots in Flight.
// Nothing here knows the channel, except that a snapshot may be too large for a datagram.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/ClientViewport.h"
#include "host/snapshot/Flight.h"
#include "host/snapshot/Interest.h"
#include "host/snapshot/LossDetector.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SentChecksums.h"
#include "host/snapshot/SnapshotBuilder.h"
#include "host/snapshot/SnapshotPackets.h"
#include "shared/replica/Acks.h"

namespace naiad {

/// When records that were not acknowledged are sent again.
enum class Resend {
  kEveryTick,  ///< with every snapshot, until they are
  kOnGap,      ///< when later snapshots are acknowledged and theirs is not
  kAhead,      ///< as kOnGap, and on a line that loses packets with redundancy (RedundantResend)
};

class SnapshotSender {
 public:
  using Packet = SnapshotPacket;
  using Packets = SnapshotPackets;

  explicit SnapshotSender(Resend resend = Resend::kAhead) : m_resend(resend) {}

  /// Take in one published tick and what this player sees of it. To be called after every Publisher::update
  /// while the client is connected. After the first call all that the client sees is pending.
  void applyTick(const Publisher& publisher, const df::PlayerFacts& player);
  /// The newest input that the game has had, and its tick. To be called before the build() of that tick.
  void noteInput(std::uint32_t id, std::uint32_t tick) { m_replica.state.noteInput(id, tick); }
  /// The client's terminal, in cells; 0: unknown.
  void setTerminal(std::uint32_t columns, std::uint32_t rows) { m_viewport.setTerminal(columns, rows); }
  /// Is the client sent all of a view of this size, and not only what fits in its terminal?
  bool coversView(int width, int height) const { return m_viewport.covers(width, height); }
  /// An object is sent when it may enter the view within so many ticks.
  void setLookAhead(std::uint32_t ticks) { m_look_ahead = ticks; }

  /// Write what is pending at the publisher's tick, most urgent first, up to kMaxInFlight unacknowledged
  /// snapshots. Where nothing is pending or that window is full: one snapshot every kKeepAlive ticks, else
  /// none.
  void build(const Publisher& publisher, PacketLimits limits, Packets& packets);
  std::vector<Packet> build(const Publisher& publisher, PacketLimits limits = {}) {
    Packets packets;
    build(publisher, limits, packets);
    return {packets.begin(), packets.end()};
  }

  /// A snapshot at the publisher's tick that carries nothing, to find out whether datagrams pass. Its loss
  /// says nothing of the line.
  Packet probe(const Publisher& publisher);

  /// The client acknowledged. A number that it leaves out counts as lost, at once or with some patience
  /// (LossEstimator).
  void acknowledge(const AckWindow& acks);
  /// The snapshot, just built, is large and goes on a stream: it is late rather than lost.
  void markLarge(std::uint32_t number) { m_flight.markLarge(number); }
  /// A large snapshot is unacknowledged. One that overtook it would show a world without it.
  bool hasLargeInFlight() const { return m_flight.hasLarge(); }
  /// The stream is gone, and what was sent on it is pending again.
  void requeueLarge();

  /// Is this the checksum of a client that has received the snapshots in `acks`? Nothing if too little is
  /// known of that moment. To be called after acknowledge().
  std::optional<bool> matchesChecksum(const AckWindow& acks, std::uint64_t checksum) const {
    return m_checksums.matches(acks, checksum);
  }
  /// Start again: the client forgets the world, and all of it is pending.
  void reset();

  /// Something was pending at the last build() that could not be sent.
  bool isThrottled() const { return m_throttled; }
  /// Nothing is pending and nothing unacknowledged.
  bool isSettled() const { return !m_flight.hasContent() && !m_replica.hasPending(); }
  /// Share of the last snapshots that were lost, 0 … 1, smoothed.
  double loss() const { return m_losses.estimator().loss(); }
  /// Objects sent again because a snapshot was lost.
  std::uint64_t resentCount() const { return m_resent; }
  std::size_t knownCount() const { return m_replica.objects.aliveCount(); }
  const KnownObjects& known() const { return m_replica.objects; }
  std::uint32_t newestNumber() const { return m_next_number - 1; }
  /// Of the world, as the client knows it: counts resets, modulo 4.
  std::uint8_t epoch() const { return m_epoch; }

  static constexpr std::uint32_t kKeepAlive = 5;
  /// Snapshots unacknowledged at most; the oldest beyond that counts as lost.
  static constexpr std::size_t kMaxInFlight = Flight::kMaxSnapshots;

 private:
  void queueRecords(const Publisher& publisher);
  bool isKeepAliveDue() const;
  bool writeSnapshot(const Publisher& publisher, const PacketLimits& limits, Packet& packet);
  void finishSnapshot(Packet& packet);
  void removeNewest();
  void settleOldest();
  void requeueLost(const Flight::Snapshot& snapshot);
  RedundantResend* redundancy();

  Resend m_resend;
  ClientReplica m_replica;
  ClientViewport m_viewport;
  Interest m_interest;
  Flight m_flight;
  SentChecksums m_checksums;
  LossDetector m_losses;
  RedundantResend m_redundancy;
  std::uint32_t m_next_number = 1;
  std::uint32_t m_last_tick = 0;  ///< of the last snapshot built
  std::uint32_t m_tick = 0;
  std::uint32_t m_look_ahead = 4;
  bool m_has_ticks = false;
  bool m_throttled = false;
  std::uint8_t m_epoch = 0;
  std::uint64_t m_resent = 0;
};

}  // namespace naiad
