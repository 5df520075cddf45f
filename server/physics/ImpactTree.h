// The broad phase of the event-exact storey: a tree of boxes, each around what a body sweeps in a tick.
//
// The order in which a query finds bodies depends on the whole scene; nobody may let a result depend on it.
#pragma once

#include <cstdint>
#include <vector>

#include "Vec2.h"

namespace naiad::physics {

struct SweptBox {
  Vec2 low;
  Vec2 high;
};

constexpr bool overlaps(const SweptBox& a, const SweptBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}
constexpr bool contains(const SweptBox& a, const SweptBox& b) {
  return a.low.x <= b.low.x && b.high.x <= a.high.x && a.low.y <= b.low.y && b.high.y <= a.high.y;
}
constexpr SweptBox join(const SweptBox& a, const SweptBox& b) {
  return {{a.low.x < b.low.x ? a.low.x : b.low.x, a.low.y < b.low.y ? a.low.y : b.low.y},
          {a.high.x > b.high.x ? a.high.x : b.high.x, a.high.y > b.high.y ? a.high.y : b.high.y}};
}

/// A leaf per body; n·log n to build, n to refit, about log n to ask or to let one leaf grow. Keeps its
/// memory.
class ImpactTree {
 public:
  /// Takes `boxes[i]` for the bodies `ids[i]`, ids below `id_count`. Refits the old tree if the ids are the
  /// same and its boxes have not spread too far, and builds it anew otherwise.
  void update(const std::vector<SweptBox>& boxes, const std::vector<int>& ids, int id_count);

  const SweptBox& box(int id) const { return m_nodes[m_leaf_of[id]].box; }

  /// Lets the box of a body grow to take in `box`.
  void grow(int id, const SweptBox& box);

  /// Calls found(id) for every body whose box overlaps `box`.
  template <typename Found>
  void query(const SweptBox& box, Found&& found) const {
    if (m_nodes.empty() || !overlaps(m_nodes[0].box, box)) return;
    int stack[kDepth];
    int height = 0;
    stack[height++] = 0;
    while (height > 0) {
      const Node& node = m_nodes[stack[--height]];
      if (node.id >= 0) {
        found(node.id);
        continue;
      }
      if (overlaps(m_nodes[node.first].box, box)) stack[height++] = node.first;
      if (overlaps(m_nodes[node.second].box, box)) stack[height++] = node.second;
    }
  }

 private:
  static constexpr int kDepth = 128;  // halved at every level: far more than any number of bodies needs
  struct Node {
    SweptBox box;
    int parent;
    int id;  // of the leaf's body; −1 above
    int first;
    int second;
  };

  int build(int begin, int end, int parent);
  double refit();

  std::vector<Node> m_nodes;
  std::vector<int> m_leaf_of;
  std::vector<int> m_ids;  // of the last build, as given
  std::vector<int> m_order;
  const std::vector<SweptBox>* m_boxes = nullptr;  // during update()
  double m_built_size = 0;
};

}  // namespace naiad::physics
