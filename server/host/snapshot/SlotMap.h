// A small map from world slots to a client's ids: open addressing, no allocation per entry.
#pragma once

#include <cstdint>
#include <vector>

namespace naiad {

class SlotMap {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Returns the id stored for `slot`; kNone if none.
  std::uint32_t find(std::uint32_t slot) const {
    if (m_entries.empty()) return kNone;
    for (std::size_t i = home(slot);; i = next(i)) {
      if (m_entries[i].slot == slot) return m_entries[i].id;
      if (m_entries[i].slot == kNone) return kNone;
    }
  }
  /// Prefetches memory for a later find(slot).
  void prefetch(std::uint32_t slot) const {
    if (!m_entries.empty()) __builtin_prefetch(&m_entries[home(slot)]);
  }
  /// Adds `slot`, which must not be in the map.
  void insert(std::uint32_t slot, std::uint32_t id) {
    if (2 * (m_count + 1) > m_entries.size()) grow();
    std::size_t i = home(slot);
    while (m_entries[i].slot != kNone) i = next(i);
    m_entries[i] = {slot, id};
    ++m_count;
  }
  /// Removes `slot`, which must be in the map.
  void erase(std::uint32_t slot) {
    std::size_t hole = home(slot);
    while (m_entries[hole].slot != slot) hole = next(hole);
    // Move later entries into the hole if find() could no longer reach them.
    for (std::size_t i = next(hole); m_entries[i].slot != kNone; i = next(i)) {
      const std::size_t wanted = home(m_entries[i].slot);
      const bool reachable = hole < i ? wanted > hole && wanted <= i : wanted > hole || wanted <= i;
      if (reachable) continue;
      m_entries[hole] = m_entries[i];
      hole = i;
    }
    m_entries[hole] = {};
    --m_count;
  }

 private:
  struct Bucket {
    std::uint32_t slot = kNone;
    std::uint32_t id = kNone;
  };
  std::size_t home(std::uint32_t slot) const { return (slot * 0x9E3779B1u >> 7) & (m_entries.size() - 1); }
  std::size_t next(std::size_t i) const { return (i + 1) & (m_entries.size() - 1); }
  void grow() {
    std::vector<Bucket> old(m_entries.empty() ? 16 : 2 * m_entries.size());
    old.swap(m_entries);
    m_count = 0;
    for (const Bucket& entry : old) {
      if (entry.slot != kNone) insert(entry.slot, entry.id);
    }
  }

  std::vector<Bucket> m_entries;
  std::size_t m_count = 0;
};

}  // namespace naiad
