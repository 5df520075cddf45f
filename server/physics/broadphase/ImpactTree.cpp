#include "physics/broadphase/ImpactTree.h"

#include <algorithm>

namespace naiad::physics {

void ImpactTree::update(const std::vector<SweptBox>& boxes, const std::vector<int>& ids, int id_count,
                        const std::vector<float>& values) {
  constexpr double kSpread = 1.3;  // if the sum of all sizes grows by a larger factor, the tree is rebuilt
  m_boxes = &boxes;
  const auto setValues = [&] {
    for (std::size_t i = 0; i < values.size(); ++i) m_nodes[m_leaf_of[ids[i]]].least = values[i];
  };
  if (!ids.empty() && ids == m_ids) {
    for (std::size_t i = 0; i < ids.size(); ++i) m_nodes[m_leaf_of[ids[i]]].box = boxes[i];
    setValues();
    if (refit() <= kSpread * m_built_size) return;
  }
  m_ids = ids;
  m_leaf_of.assign(id_count, -1);
  m_order.resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) m_order[i] = static_cast<int>(i);
  m_nodes.clear();
  m_nodes.reserve(2 * ids.size());
  if (!ids.empty()) build(0, static_cast<int>(ids.size()), -1);
  setValues();
  m_built_size = refit();
}

// Stores parents before their children, so that refit() can go backwards.
void ImpactTree::build(int begin, int end, int parent) {
  const int node = static_cast<int>(m_nodes.size());
  m_nodes.push_back({(*m_boxes)[m_order[begin]], parent, -1, node + 2 * (end - begin) - 1, 0});
  if (end - begin == 1) {
    const int id = m_ids[m_order[begin]];
    m_nodes[node].id = id;
    m_leaf_of[id] = node;
    return;
  }
  const auto middleOf = [&](int i) { return (*m_boxes)[i].low + (*m_boxes)[i].high; };
  Vec2 low = middleOf(m_order[begin]), high = low;
  for (int i = begin + 1; i < end; ++i) {
    const Vec2 middle = middleOf(m_order[i]);
    low = {std::min(low.x, middle.x), std::min(low.y, middle.y)};
    high = {std::max(high.x, middle.x), std::max(high.y, middle.y)};
  }
  const bool is_wide = high.x - low.x >= high.y - low.y;
  const int half = begin + (end - begin) / 2;
  std::nth_element(m_order.begin() + begin, m_order.begin() + half, m_order.begin() + end, [&](int a, int b) {
    const double at_a = is_wide ? middleOf(a).x : middleOf(a).y;
    const double at_b = is_wide ? middleOf(b).x : middleOf(b).y;
    return at_a != at_b ? at_a < at_b : a < b;
  });
  build(begin, half, node);
  build(half, end, node);
}

// Sets the boxes of all nodes from their children's. Returns the sum of the nodes' sizes.
double ImpactTree::refit() {
  double size = 0;
  for (int i = this->size(); i-- > 0;) {
    Node& node = m_nodes[i];
    if (node.id < 0) {
      const Node &first = m_nodes[i + 1], &second = m_nodes[secondOf(i)];
      node.box = join(first.box, second.box);
      node.least = std::min(first.least, second.least);
    }
    size += sizeOf(node.box);
  }
  return size;
}

void ImpactTree::grow(int id, const SweptBox& box) {
  for (int i = m_leaf_of[id]; i >= 0 && !contains(m_nodes[i].box, box); i = m_nodes[i].parent) {
    m_nodes[i].box = join(m_nodes[i].box, box);
  }
}

}  // namespace naiad::physics
