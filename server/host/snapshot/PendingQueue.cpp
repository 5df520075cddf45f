#include "host/snapshot/PendingQueue.h"

#include <algorithm>
#include <functional>

#include "host/snapshot/SnapshotPackets.h"
#include "host/snapshot/Urgency.h"

namespace naiad {

namespace {

/// An upper bound for the record of any object in this state.
std::size_t maxBits(std::uint32_t id, const ClientReplica& replica, const Publisher& publisher) {
  constexpr std::size_t kLifeBits = 112;
  constexpr std::size_t kMotionBits = 448;
  constexpr std::size_t kBodyBits = 384;
  constexpr std::size_t kLookBits = 192;
  constexpr std::size_t kFrameBits = 32;
  constexpr std::size_t kGlyphBits = 128;
  const std::uint8_t groups = replica.objects.groupsToSend(id);
  std::size_t bits = kLifeBits;
  if ((groups & kMotion) != 0) bits += kMotionBits;
  if ((groups & kBody) != 0) bits += kBodyBits;
  if ((groups & kLook) == 0) return bits;
  const Sequence& sequence = publisher.find(replica.objects.at(id).slot)->state.look.sequence;
  return bits + kLookBits + kFrameBits * sequence.size() + kGlyphBits * sequence.glyphCount();
}

}  // namespace

void PendingQueue::fill(const ClientReplica& replica, const Publisher& publisher, std::size_t limit) {
  m_ids.clear();
  std::size_t bits = PacketLimits::kMaxOverheadBits + replica.state.maxPendingBits();
  for (const std::uint32_t id : replica.objects.pendingIds()) {
    m_ids.push_back(id);
    if (bits <= 8 * limit) bits += maxBits(id, replica, publisher);
  }
  if (bits <= 8 * limit) return std::sort(m_ids.begin(), m_ids.end(), std::greater<>());
  m_ranked.clear();
  const Urgency urgency(replica, publisher);
  for (const std::uint32_t id : m_ids) m_ranked.emplace_back(urgency.of(id), id);
  // Equal urgency: by id, so that a run is the same everywhere.
  std::sort(m_ranked.begin(), m_ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  std::transform(m_ranked.begin(), m_ranked.end(), m_ids.begin(), [](const auto& r) { return r.second; });
}

}  // namespace naiad
