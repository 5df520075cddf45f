#include "host/snapshot/SentChecksums.h"

namespace naiad {

void SentChecksums::recordComplete(std::uint32_t number) {
  if (!m_repairing) return;
  m_clean_from = number;
  m_repairing = false;
}

void SentChecksums::recordLost(const Flight::Snapshot& snapshot, bool pending, std::uint32_t newest) {
  m_repairing = m_repairing || pending;
  // Where nothing is missing, newer snapshots have carried the same.
  if (!snapshot.empty && isNewer(newest, m_clean_from)) m_clean_from = newest;
  Moment& moment = at(snapshot.number);
  if (moment.number == snapshot.number) moment.fate = snapshot.empty ? Moment::kNotMissed : Moment::kRepaired;
}

std::optional<bool> SentChecksums::matches(const AckWindow& acks, std::uint64_t checksum) const {
  const std::uint32_t number = acks.newest;
  if (m_repairing || isNewer(m_clean_from, number)) return std::nullopt;
  // Every snapshot that is missing must be known to be lost, and its contents sent again since. Those older
  // than the window are.
  const Moment* acknowledged = nullptr;
  for (const Moment& moment : m_moments) {
    const std::uint32_t behind = number - moment.number;
    if (behind == 0 && moment.number != 0) acknowledged = &moment;
    if (moment.number == 0 || behind == 0 || behind > Flight::kMaxSnapshots || acks.has(moment.number))
      continue;
    if (moment.fate == Moment::kNotMissed) continue;
    if (moment.fate != Moment::kRepaired || !isNewer(m_clean_from, moment.number)) return std::nullopt;
  }
  if (acknowledged == nullptr) return std::nullopt;
  return acknowledged->checksum == checksum;
}

}  // namespace naiad
