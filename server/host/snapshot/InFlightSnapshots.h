// One client's snapshots in flight: the contents of each, until it has arrived or counts as lost.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/snapshot/KnownObjects.h"

namespace naiad {

/// Snapshots in the order of sending. Reuses the memory of removed ones.
class InFlightSnapshots {
 public:
  struct Snapshot {
    std::uint32_t number = 0;
    bool large = false;  ///< uses a stream: may be late, but is lost only if the stream breaks
    bool empty = true;
    bool probe = false;
    std::vector<KnownObjects::Sent> objects;
    std::vector<std::pair<std::uint32_t, std::uint64_t>>
        names;  ///< id and checksum of each appearance that the snapshot defines
  };
  /// Maximum number in flight. If one more is sent, the oldest counts as lost.
  static constexpr std::size_t kMaxSnapshots = 64;

  std::size_t size() const { return m_count; }
  /// Adds a snapshot that is about to be written; it becomes newest().
  Snapshot& add(std::uint32_t number) {
    if (m_count == m_snapshots.size()) m_snapshots.emplace_back();
    Snapshot& snapshot = m_snapshots[m_count++];
    snapshot.number = number;
    snapshot.large = snapshot.probe = false;
    snapshot.empty = true;
    snapshot.objects.clear();
    snapshot.names.clear();
    return snapshot;
  }
  Snapshot& newest() { return m_snapshots[m_count - 1]; }
  void removeNewest() { --m_count; }
  /// Marks a snapshot that uses a stream. Ignored if it is no longer in flight.
  void markLarge(std::uint32_t number) {
    for (std::size_t i = m_count; i > 0; --i) {
      if (m_snapshots[i - 1].number == number) m_snapshots[i - 1].large = true;
    }
  }
  bool hasLarge() const {
    return std::any_of(begin(), end(), [](const Snapshot& snapshot) { return snapshot.large; });
  }
  /// True if any snapshot in flight carries something.
  bool hasContent() const {
    return std::any_of(begin(), end(), [](const Snapshot& snapshot) { return !snapshot.empty; });
  }
  /// Calls `settle(snapshot)` from the oldest to the newest, and removes those for which it returns true.
  template <class Settle>
  void removeIf(Settle settle) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < m_count; ++i) {
      if (settle(std::as_const(m_snapshots[i]))) continue;
      if (kept != i) std::swap(m_snapshots[kept], m_snapshots[i]);
      ++kept;
    }
    m_count = kept;
  }

 private:
  const Snapshot* begin() const { return m_snapshots.data(); }
  const Snapshot* end() const { return m_snapshots.data() + m_count; }

  std::vector<Snapshot> m_snapshots;  ///< the first m_count are in use
  std::size_t m_count = 0;
};

}  // namespace naiad
