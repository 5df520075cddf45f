// One client's snapshots: writes the pending state, and sends it again if it is lost.
//
// A client receives the objects in its view, objects about to enter it, and the objects that its view follows
// and its player steers. In each tick, Interest decides which objects the client knows, and SnapshotBuilder
// writes what is pending in ClientReplica, most urgent first. Acknowledgements remove snapshots from
// InFlightSnapshots. Nothing here depends on the channel, except that a snapshot may exceed a datagram.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/ClientViewport.h"
#include "host/snapshot/InFlightSnapshots.h"
#include "host/snapshot/Interest.h"
#include "host/snapshot/LossDetector.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SentChecksums.h"
#include "host/snapshot/SnapshotBuilder.h"
#include "host/snapshot/SnapshotPackets.h"
#include "shared/replica/Acks.h"

namespace naiad {

/// When unacknowledged records are sent again.
enum class Resend {
  kEveryTick,  ///< in every tick, until they are acknowledged
  kOnGap,      ///< when later snapshots are acknowledged and the one that carried them is not
  kAhead,      ///< like kOnGap, and redundantly if the connection loses packets (RedundantResend)
};

class SnapshotSender {
 public:
  using Packet = SnapshotPacket;
  using Packets = SnapshotPackets;

  explicit SnapshotSender(Resend resend = Resend::kAhead) : m_resend(resend) {}

  /// Processes one published tick and this player's facts. Call after every Publisher::update() while the
  /// client is connected. The first call makes everything pending that the client sees.
  void applyTick(const Publisher& publisher, const df::PlayerFacts& player);
  /// Sets the newest input that the game has applied, and its tick. Call before the build() of that tick.
  void setNewestInput(std::uint32_t id, std::uint32_t tick) { m_replica.state.setNewestInput(id, tick); }
  /// Sets the size of the client's terminal, in cells; 0: unknown.
  void setTerminal(std::uint32_t columns, std::uint32_t rows) { m_viewport.setTerminal(columns, rows); }
  /// True if the client is sent the whole of a view of this size, not only the part that fits its terminal.
  bool coversView(int width, int height) const { return m_viewport.covers(width, height); }
  /// Sets how many ticks in advance an object is sent before it may enter the view.
  void setLookAhead(std::uint32_t ticks) { m_look_ahead = ticks; }

  /// Writes pending state at the publisher's tick, most urgent first, within a window of kMaxInFlight
  /// unacknowledged snapshots. If nothing is pending or it is full, writes a snapshot every kKeepAlive ticks.
  void build(const Publisher& publisher, PacketLimits limits, Packets& packets);
  std::vector<Packet> build(const Publisher& publisher, PacketLimits limits = {}) {
    Packets packets;
    build(publisher, limits, packets);
    return {packets.begin(), packets.end()};
  }

  /// Returns an empty snapshot that probes whether datagrams pass. Its loss does not count in loss().
  Packet probe(const Publisher& publisher);

  /// Processes an acknowledgement; ignores it if its newest number was never sent. LossDetector decides when
  /// unconfirmed snapshots count as lost.
  void acknowledge(const AckWindow& acks);
  /// Marks a snapshot, just built, that uses a stream: it may be late, but is lost only if the stream breaks.
  void markLarge(std::uint32_t number) { m_in_flight.markLarge(number); }
  /// True if a large snapshot is unacknowledged. If a later one overtook it, the client would lack it.
  bool hasLargeInFlight() const { return m_in_flight.hasLarge(); }
  /// Call when the stream broke: the contents of the large snapshots in flight are pending again.
  void requeueLarge();

  /// True if this is the checksum of a client that has received the snapshots in `acks`; nullopt if too
  /// little is known about that moment. Call after acknowledge().
  std::optional<bool> matchesChecksum(const AckWindow& acks, std::uint64_t checksum) const {
    return m_checksums.matches(acks, checksum);
  }
  /// Starts again from an empty client replica: the whole world becomes pending.
  void reset();

  /// True if the last build() could not send everything that was pending.
  bool isThrottled() const { return m_throttled; }
  /// True if nothing is pending and no unacknowledged snapshot carries anything.
  bool isSettled() const { return !m_in_flight.hasContent() && !m_replica.hasPending(); }
  /// Share of the last snapshots that were lost, 0 … 1, smoothed.
  double loss() const { return m_losses.estimator().loss(); }
  /// Number of objects sent again because a snapshot was lost.
  std::uint64_t resentCount() const { return m_resent; }
  std::size_t knownCount() const { return m_replica.objects.aliveCount(); }
  const KnownObjects& known() const { return m_replica.objects; }
  std::uint32_t newestNumber() const { return m_next_number - 1; }
  /// Number of resets of the client's world, modulo 4.
  std::uint8_t epoch() const { return m_epoch; }

  static constexpr std::uint32_t kKeepAlive = 5;
  /// Maximum number of unacknowledged snapshots. If one more is sent, the oldest counts as lost.
  static constexpr std::size_t kMaxInFlight = InFlightSnapshots::kMaxSnapshots;

 private:
  void queueRecords(const Publisher& publisher);
  bool isKeepAliveDue() const;
  bool writeSnapshot(const Publisher& publisher, const PacketLimits& limits, Packet& packet);
  void finishSnapshot(Packet& packet);
  void removeNewest();
  void settleOldest();
  void requeueLost(const InFlightSnapshots::Snapshot& snapshot);
  RedundantResend* redundancy();

  Resend m_resend;
  ClientReplica m_replica;
  ClientViewport m_viewport;
  Interest m_interest;
  InFlightSnapshots m_in_flight;
  SentChecksums m_checksums;
  LossDetector m_losses;
  RedundantResend m_redundancy;
  std::uint32_t m_next_number = 1;
  std::uint32_t m_last_tick = 0;  ///< tick of the newest snapshot built
  std::uint32_t m_tick = 0;
  std::uint32_t m_look_ahead = 4;
  bool m_has_ticks = false;
  bool m_throttled = false;
  std::uint8_t m_epoch = 0;
  std::uint64_t m_resent = 0;
};

}  // namespace naiad
