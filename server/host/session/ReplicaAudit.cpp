#include "host/session/ReplicaAudit.h"

#include <algorithm>
#include <utility>

namespace naiad {

namespace {

/// Snapshots farther than this before the newest acknowledged one can no longer be acknowledged (AckWindow).
constexpr std::uint32_t kWindow = 64;

}  // namespace

void ReplicaAudit::beginTick(std::uint32_t newest, std::uint32_t tick) {
  if (m_state != State::kBegins) return;
  m_state = State::kRuns;
  m_shadow = Replica::continuing({newest, tick, 0});
  m_header = {};
  m_sent.clear();
  m_truths.clear();
}

void ReplicaAudit::recordSent(const SnapshotPacket& packet) {
  if (m_state != State::kRuns) return;
  if (m_sent.size() >= kMaxSent) m_sent.pop_front();
  m_sent.push_back({packet.number, packet.bytes});
}

void ReplicaAudit::recordTruth(std::uint32_t tick, df::Canvas picture) {
  if (m_state == State::kWaits) return;
  if (m_truths.size() >= kMaxTruths) m_truths.pop_front();
  m_truths.push_back({tick, std::move(picture)});
}

void ReplicaAudit::acknowledge(const AckWindow& acks, const SnapshotSender& sender) {
  if (m_state != State::kRuns || isNewer(acks.newest, sender.newestNumber())) return;
  applyAcknowledged(acks);
  if (m_header.number != acks.newest || !m_header.complete) return;
  while (!m_truths.empty() && isNewer(m_header.tick, m_truths.front().tick)) m_truths.pop_front();
  if (m_truths.empty() || m_truths.front().tick != m_header.tick) return;
  const df::Canvas truth = std::move(m_truths.front().picture);
  m_truths.pop_front();
  // A terminal smaller than the view is sent only a part of it, and lost changes may be missing for a while.
  if (!sender.coversView(m_shadow.viewWidth(), m_shadow.viewHeight())) return;
  if (!sender.matchesChecksum(acks, m_shadow.checksum())) return;
  ++m_counters.audited_pictures;
  m_counters.audited_cells +=
      static_cast<std::uint64_t>(truth.width()) * static_cast<std::uint64_t>(truth.height());
  m_counters.wrong_cells +=
      static_cast<std::uint64_t>(countDifferences(m_shadow.render(m_header.tick), truth));
}

void ReplicaAudit::applyAcknowledged(const AckWindow& acks) {
  for (const Sent& sent : m_sent) {
    if (acks.has(sent.number)) apply(sent.bytes);
  }
  std::erase_if(m_sent, [&acks](const Sent& sent) {
    return acks.has(sent.number) ||
           static_cast<std::int32_t>(acks.newest - sent.number) > static_cast<std::int32_t>(kWindow);
  });
}

// Skips unreadable snapshots, which the client does not acknowledge.
void ReplicaAudit::apply(const std::string& bytes) {
  Snapshot snapshot;
  if (m_shadow.read(bytes, snapshot) != ReadResult::kOk) return;
  m_shadow.apply(snapshot);
  if (m_header.number == 0 || isNewer(snapshot.header.number, m_header.number)) m_header = snapshot.header;
}

}  // namespace naiad
