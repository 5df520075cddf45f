// Writes what is pending for one client into snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/Flight.h"
#include "host/snapshot/PendingQueue.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/RedundantResend.h"
#include "host/snapshot/SnapshotPackets.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

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
