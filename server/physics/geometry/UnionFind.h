// Which of many things hang together.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "physics/geometry/Index.h"

namespace naiad::physics {

/// Sets of numbers from 0 on, which only grow together. The lowest number of a set is its root, whatever the
/// order in which they were united. Keeps its memory.
class UnionFind {
 public:
  /// So many numbers, each alone.
  void reset(std::size_t count) {
    m_parent.clear();
    extend(count);
  }
  /// So many in all; the new ones alone.
  void extend(std::size_t count) {
    const std::size_t before = m_parent.size();
    m_parent.resize(count);
    std::iota(m_parent.begin() + static_cast<std::ptrdiff_t>(before), m_parent.end(),
              static_cast<int>(before));
  }
  int rootOf(int i) {
    while (m_parent[at(i)] != i) i = m_parent[at(i)] = m_parent[at(m_parent[at(i)])];
    return i;
  }
  void unite(int a, int b) {
    a = rootOf(a), b = rootOf(b);
    m_parent[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> m_parent;
};

}  // namespace naiad::physics
