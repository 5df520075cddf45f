#include "client/world/EpochReplicas.h"

#include <utility>

namespace naiad {

// Snapshot numbers continue through all epochs. So a snapshot of another epoch that is not newer than all
// snapshots of this world is a late one of an earlier world. (One of two streams may lag by several worlds.)
Replica* EpochReplicas::replicaFor(std::string_view bytes, Time now) {
  const auto epoch = peekEpoch(bytes);
  if (!epoch || *epoch == m_epoch) return &m_replica;
  if (m_next && m_next_epoch == *epoch) return &*m_next;
  const auto header = peekHeader(bytes, m_replica.newest());
  if (!header) return &m_replica;
  if (!isNewer(header->number, (m_next ? *m_next : m_replica).newest().number)) return nullptr;
  m_next_epoch = *epoch;
  m_next = Replica::continuing(m_replica.newest());
  m_reset_at = now;
  ++m_resets;
  return &*m_next;
}

// A complete snapshot may overtake earlier ones: it may come as a datagram and they on the stream.
void EpochReplicas::trackFirstWorld(const SnapshotHeader& header, Time now) {
  if (!m_first_at) m_first_at = now;
  m_arrived.addReceived(header.number);
  if (header.complete && isNewer(header.number, m_complete)) m_complete = header.number;
  m_first_complete = m_complete != m_before;
  // The contents of snapshots older than the window were sent again before the server marked one complete.
  for (std::uint32_t n = m_complete; m_first_complete && n != m_before && m_arrived.newest - n <= 64; --n) {
    m_first_complete = m_arrived.has(n);
  }
}

EpochReplicas::Result EpochReplicas::applySnapshot(std::string_view bytes, Time now, SnapshotHeader& header,
                                                   const std::function<void(std::uint32_t)>& before) {
  Replica* replica = replicaFor(bytes, now);
  if (replica == nullptr) return Result::kIgnored;
  Snapshot snapshot;
  const ReadResult read = replica->read(bytes, snapshot);
  if (read == ReadResult::kMalformed) return Result::kMalformed;
  m_stale_in_a_row = read == ReadResult::kStale ? m_stale_in_a_row + 1 : 0;
  if (read == ReadResult::kStale) return Result::kStale;
  header = snapshot.header;
  if (before) before(header.tick);
  replica->apply(snapshot);
  if (!m_first_complete && replica == &m_replica) trackFirstWorld(header, now);
  if (replica == &m_replica || !(header.complete || now - m_reset_at >= kIncompleteTimeout)) {
    return Result::kApplied;
  }
  m_first_complete = true;
  m_replica = std::move(*m_next);
  m_next.reset();
  m_epoch = m_next_epoch;
  return Result::kShown;
}

// The first snapshots of the new world may have overtaken this announcement: then their replica is kept.
void EpochReplicas::expectWorld(std::uint8_t epoch, std::uint32_t tick, Time now) {
  if (epoch == m_epoch || (m_next && m_next_epoch == epoch)) return;
  SnapshotContext near = (m_next ? *m_next : m_replica).newest();
  near.tick = tick;
  m_next_epoch = epoch;
  m_next = Replica::continuing(near);
  m_reset_at = now;
  ++m_resets;
}

void EpochReplicas::advanceTick(std::uint32_t tick) {
  m_replica.advanceTick(tick);
  if (m_next) m_next->advanceTick(tick);
}

}  // namespace naiad
