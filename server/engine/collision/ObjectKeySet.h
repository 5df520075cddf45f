// A set of Objects by their handles that keeps its memory when it is emptied, for the lists of a move.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/collision/ObjectKey.h"

namespace df {

class ObjectKeySet {
 public:
  bool isEmpty() const { return m_count == 0; }
  bool contains(ObjectKey key) const { return m_count != 0 && m_places[find(key)] == key; }
  void insert(ObjectKey key) {
    if (m_count * 2 >= m_places.size()) grow();
    ObjectKey& place = m_places[find(key)];
    if (place == key) return;
    place = key;
    ++m_count;
  }
  void clear() {
    if (m_count == 0) return;
    m_count = 0;
    if (m_places.size() <= kMax) {
      m_places.assign(m_places.size(), {});
    } else {  // frees the large table, because every later clear() would have to wipe it all
      m_places = {};
    }
  }

 private:
  static constexpr std::size_t kMin = 16;    // first size of the table; a power of two
  static constexpr std::size_t kMax = 1024;  // largest size that clear() keeps

  // Returns the index of the key or of a free entry. A free entry has generation 0, an Object at least 1.
  std::size_t find(ObjectKey key) const {
    const std::uint64_t hash =
        ((std::uint64_t{key.generation} << 32) | key.slot) * std::uint64_t{0x9E3779B97F4A7C15};
    const std::size_t mask = m_places.size() - 1;
    std::size_t i = static_cast<std::size_t>(hash >> 32) & mask;
    while (m_places[i].generation != 0 && m_places[i] != key) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<ObjectKey> before(m_places.empty() ? kMin : m_places.size() * 2);
    before.swap(m_places);
    for (const ObjectKey key : before) {
      if (key.generation != 0) m_places[find(key)] = key;
    }
  }

  std::vector<ObjectKey> m_places;
  std::size_t m_count = 0;
};

}  // namespace df
