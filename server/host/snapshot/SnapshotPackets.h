// The encoded snapshots of one client and tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/replica/Limits.h"

namespace naiad {

struct SnapshotPacket {
  std::uint32_t number = 0;
  std::uint32_t tick = 0;
  bool large = false;  ///< exceeds the datagram limit, so it needs a stream
  std::string bytes;
};

/// Limits of the snapshots that one tick may send.
struct PacketLimits {
  /// Upper bound of the bits that a snapshot of one object has in addition to the object's record.
  static constexpr std::size_t kMaxOverheadBits = 256;

  std::size_t packets = 64;                  ///< maximum number of snapshots
  std::size_t bytes = kMaxDatagramSnapshot;  ///< maximum size of each snapshot
  bool large = true;                         ///< true: one snapshot may exceed `bytes`, up to kMaxSnapshot
};

/// Reuses the memory of cleared packets.
class SnapshotPackets {
 public:
  SnapshotPacket& add() {
    if (m_count == m_all.size()) m_all.emplace_back();
    SnapshotPacket& packet = m_all[m_count++];
    packet.large = false;
    return packet;
  }
  void removeLast() { --m_count; }
  void clear() { m_count = 0; }
  std::size_t size() const { return m_count; }
  bool empty() const { return m_count == 0; }
  const SnapshotPacket* begin() const { return m_all.data(); }
  const SnapshotPacket* end() const { return m_all.data() + m_count; }
  const SnapshotPacket& back() const { return m_all[m_count - 1]; }

 private:
  std::vector<SnapshotPacket> m_all;  ///< the first m_count are in use
  std::size_t m_count = 0;
};

}  // namespace naiad
