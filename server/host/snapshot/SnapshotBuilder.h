// Writes what is pending for one client into snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/Flight.h"
#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotPackets.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

/// Redundancy: on a line that loses packets, records are sent again in the next tick, before a loss is known.
/// Short ones are sent once more in the tick after, since lines sometimes lose two packets in a row.
class RedundantResend {
 public:
  /// Of all records repeated in a tick; the first one may be longer.
  static constexpr std::size_t kBits = 768;
  /// A record of at most so many bits is repeated twice.
  static constexpr std::size_t kShortBits = 32;

  /// A record was just written. Of the records that are to be repeated, those of the highest urgency are.
  void addRecord(const KnownObjects::Sent& sent, std::size_t bits, double urgency);
  /// Begin the next tick: records that are unconfirmed are pending again, within the budget.
  void requeueRecords(KnownObjects& known, std::uint32_t tick);

 private:
  struct Record {
    double urgency = 0;
    std::size_t bits = 0;
    KnownObjects::Sent sent;
    int repeats = 0;
  };

  std::vector<Record> m_next;     ///< for the next tick
  std::vector<Record> m_current;  ///< repeated in this one
};

/// The order in which one client's pending objects are written, the most urgent first.
class PendingQueue {
 public:
  /// Take all pending ids: by id if one snapshot of `limit` bytes holds them all, else by urgency.
  void fill(const ClientReplica& replica, const Publisher& publisher, std::size_t limit);
  bool empty() const { return m_ids.empty(); }
  std::uint32_t front() const { return m_ids.back(); }
  void pop() { m_ids.pop_back(); }
  /// Take the front out until restoreDeferred().
  void defer() {
    m_deferred.push_back(m_ids.back());
    m_ids.pop_back();
  }
  void restoreDeferred() {
    m_ids.insert(m_ids.end(), m_deferred.rbegin(), m_deferred.rend());
    m_deferred.clear();
  }

 private:
  std::vector<std::uint32_t> m_ids;  ///< the most urgent last
  std::vector<std::uint32_t> m_deferred;
  std::vector<std::pair<double, std::uint32_t>> m_ranked;  ///< scratch
};

class SnapshotBuilder {
 public:
  /// The senders of a thread build one after the other, so that they share one builder, which stays in the
  /// cache.
  static SnapshotBuilder& ofThread();

  /// Queue the pending objects of one client for the snapshots of a tick, which have `limit` bytes each.
  void queueObjects(const ClientReplica& replica, const Publisher& publisher, std::size_t limit) {
    m_queue.fill(replica, publisher, limit);
  }
  /// Begin a snapshot of the client. What is written is marked as sent in `replica` and listed in `flight`,
  /// which it must outlive. Records to repeat go to `redundancy`, unless it is null.
  void beginSnapshot(const SnapshotHeader& header, ClientReplica& replica, Flight::Snapshot& flight,
                     RedundantResend* redundancy = nullptr);
  /// Write what is pending beside objects, as far as it fits into `limit` bytes.
  void writeState(std::size_t limit);
  /// Write queued objects until the snapshot is full.
  void writeObjects(const Publisher& publisher, const PacketLimits& limits);
  void finish(bool complete, std::string& bytes);

 private:
  /// What is staged in the writer.
  struct Record {
    std::uint32_t id = 0;
    std::size_t bits = 0;
    const Publisher::Model* p_model = nullptr;  ///< null: a death
    const SharedMotion* p_motion = nullptr;     ///< null: no motion is sent
    LookForm form;
  };
  Record stageRecord(std::uint32_t id, const Publisher& publisher);
  void keepRecord(const Record& record, const Publisher& publisher);

  SnapshotWriter m_writer;
  PendingQueue m_queue;
  SnapshotHeader m_header;
  ClientReplica* m_p_replica = nullptr;  ///< these three: of the snapshot that was begun
  Flight::Snapshot* m_p_flight = nullptr;
  RedundantResend* m_p_redundancy = nullptr;
};

}  // namespace naiad
