// Connected sets of numbers.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "physics/geometry/Index.h"

namespace naiad::physics {

/// Disjoint sets of the numbers from 0 on, which can be united. The lowest number of a set is its root,
/// independent of the order in which sets were united. Keeps its memory.
class UnionFind {
 public:
  /// Makes `count` sets, each with one number.
  void reset(std::size_t count) {
    m_parent.clear();
    extend(count);
  }
  /// Extends to `count` numbers in all; each new number is a set by itself.
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
