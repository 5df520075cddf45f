// Writes the pending state and objects of one client into snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/InFlightSnapshots.h"
#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotPackets.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

/// Redundancy if packets get lost: records are sent again in the next tick, before a loss is known. Short
/// ones are sent a third time in the tick after, because sometimes two packets in a row are lost.
class RedundantResend {
 public:
  /// Limit of the total bits of the records repeated in a tick. The first record may exceed it.
  static constexpr std::size_t kBits = 768;
  /// Records of at most this many bits are repeated twice.
  static constexpr std::size_t kShortBits = 32;

  /// Call for each record written. The records with the highest urgency are repeated first.
  void addRecord(const KnownObjects::Sent& sent, std::size_t bits, double urgency);
  /// Starts the next tick: marks unconfirmed records as pending again, within kBits.
  void requeueRecords(KnownObjects& known, std::uint32_t tick);

 private:
  struct Record {
    double urgency = 0;
    std::size_t bits = 0;
    KnownObjects::Sent sent;
    int repeats = 0;
  };

  std::vector<Record> m_next;     ///< records to repeat in the next tick
  std::vector<Record> m_current;  ///< records repeated in this tick
};

/// The order in which one client's pending objects are written, the most urgent first.
class PendingQueue {
 public:
  /// Replaces the contents by all pending ids, sorted by id if one snapshot of `limit` bytes holds them all,
  /// otherwise by urgency: first deaths, then the player's own objects, then the others by distance from the
  /// middle of the view, less the time waited.
  void fill(const ClientReplica& replica, const Publisher& publisher, std::size_t limit);
  bool empty() const { return m_ids.empty(); }
  std::uint32_t front() const { return m_ids.back(); }
  void pop() { m_ids.pop_back(); }
  /// Removes the front id until restoreDeferred() puts it back.
  void defer() {
    m_deferred.push_back(m_ids.back());
    m_ids.pop_back();
  }
  void restoreDeferred() {
    m_ids.insert(m_ids.end(), m_deferred.rbegin(), m_deferred.rend());
    m_deferred.clear();
  }

 private:
  std::vector<std::uint32_t> m_ids;  ///< ids, the most urgent last
  std::vector<std::uint32_t> m_deferred;
  std::vector<std::pair<double, std::uint32_t>> m_ranked;  ///< scratch
};

class SnapshotBuilder {
 public:
  /// Returns the builder that all senders of a thread share, so that its memory stays in the cache.
  static SnapshotBuilder& ofThread();

  /// Queues the pending objects of one client for the snapshots of a tick. `limit`: bytes of each snapshot.
  void queueObjects(const ClientReplica& replica, const Publisher& publisher, std::size_t limit) {
    m_queue.fill(replica, publisher, limit);
  }
  /// Starts a snapshot. Everything written is marked as sent in `replica` and listed in `flight`; both must
  /// outlive the writing. Records to repeat are added to `redundancy`, unless it is null.
  void beginSnapshot(const SnapshotHeader& header, ClientReplica& replica,
                     InFlightSnapshots::Snapshot& flight, RedundantResend* redundancy = nullptr);
  /// Writes the pending state other than objects, as far as it fits into `limit` bytes.
  void writeState(std::size_t limit);
  /// Writes queued objects until the snapshot is full.
  void writeObjects(const Publisher& publisher, const PacketLimits& limits);
  void finish(bool complete, std::string& bytes);

 private:
  /// The record that is staged in the writer.
  struct Record {
    std::uint32_t id = 0;
    std::size_t bits = 0;
    const Publisher::Model* p_model = nullptr;  ///< null: a death
    const SharedMotion* p_motion = nullptr;     ///< null: no motion is sent
    LookForm form;
  };
  Record stageRecord(std::uint32_t id, const Publisher& publisher);
  void commitRecord(const Record& record, const Publisher& publisher);

  SnapshotWriter m_writer;
  PendingQueue m_queue;
  SnapshotHeader m_header;
  ClientReplica* m_p_replica = nullptr;  ///< this and the next two are set by beginSnapshot()
  InFlightSnapshots::Snapshot* m_p_flight = nullptr;
  RedundantResend* m_p_redundancy = nullptr;
};

}  // namespace naiad
