// The snapshots of one client that are on their way: what each carried, until it is known whether it arrived.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/snapshot/KnownObjects.h"

namespace naiad {

/// In the order they were sent. Memory of those that are settled is used again.
class Flight {
 public:
  struct Snapshot {
    std::uint32_t number = 0;
    bool large = false;
    bool empty = true;
    bool probe = false;
    std::vector<KnownObjects::Sent> objects;
    std::vector<std::pair<std::uint32_t, std::uint64_t>> names;  ///< ids of appearances defined, their sums
  };

  std::size_t size() const { return m_count; }
  const Snapshot& at(std::size_t i) const { return m_snapshots[i]; }
  /// One more takes off; it becomes newest().
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
  /// Null if it is settled.
  Snapshot* find(std::uint32_t number) {
    for (std::size_t i = m_count; i > 0; --i) {
      if (m_snapshots[i - 1].number == number) return &m_snapshots[i - 1];
    }
    return nullptr;
  }
  Snapshot& newest() { return m_snapshots[m_count - 1]; }
  void removeNewest() { --m_count; }
  /// Remove those for which `settle(snapshot)` says so.
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
  std::vector<Snapshot> m_snapshots;  ///< the first m_count are in use
  std::size_t m_count = 0;
};

}  // namespace naiad
