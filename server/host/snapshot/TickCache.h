// Values by slot that are the same for all clients in a tick, computed when the first client asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace naiad {

template <class Value>
class TickCache {
 public:
  /// Forget all values.
  void clear() { ++m_round; }
  /// Null if it was not put there since the last clear().
  const Value* find(std::size_t index) const {
    return index < m_entries.size() && m_entries[index].round == m_round ? &m_entries[index].value : nullptr;
  }
  /// `size`: more than any index until the next clear(). The reference is valid until the next put().
  const Value& put(std::size_t index, std::size_t size, Value value) {
    m_entries.resize(size);
    m_entries[index] = {m_round, std::move(value)};
    return m_entries[index].value;
  }

 private:
  struct Entry {
    std::uint32_t round = 0;
    Value value;
  };
  std::vector<Entry> m_entries;
  std::uint32_t m_round = 1;
};

}  // namespace naiad
