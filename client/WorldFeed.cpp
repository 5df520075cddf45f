#include "WorldFeed.h"

#include <utility>

namespace naiad {

Replica* WorldFeed::replicaFor(std::string_view bytes, Time now) {
  const auto epoch = peekEpoch(bytes);
  if (!epoch || *epoch == m_epoch) return &m_replica;
  if (*epoch == ((m_epoch + 3) & 3)) return nullptr;  // a late one of the epoch before
  if (!m_next || m_next_epoch != *epoch) {
    m_next_epoch = *epoch;
    m_next = Replica::anew(m_replica.newest());
    m_reset_at = now;
    ++m_resets;
  }
  return &*m_next;
}

WorldFeed::Taken WorldFeed::take(std::string_view bytes, Time now, SnapshotHeader& header,
                                 const std::function<void(std::uint32_t)>& before) {
  Replica* replica = replicaFor(bytes, now);
  if (replica == nullptr) return Taken::kIgnored;
  Snapshot snapshot;
  switch (replica->read(bytes, snapshot)) {
    case ReadResult::kOk:
      break;
    case ReadResult::kStale:
      ++m_stale_in_a_row;
      return Taken::kStale;
    case ReadResult::kMalformed:
      return Taken::kMalformed;
  }
  m_stale_in_a_row = 0;
  header = snapshot.header;
  if (before) before(header.tick);
  replica->apply(snapshot);
  if (replica == &m_replica || !(header.complete || now - m_reset_at >= kResetPatience)) {
    return Taken::kApplied;
  }
  m_replica = std::move(*m_next);
  m_next.reset();
  m_epoch = m_next_epoch;
  return Taken::kShown;
}

}  // namespace naiad
