// The broad phase of bodies that do not turn: a tree of boxes, each around what a body sweeps in a tick.
//
// The problem is all pairs of swept boxes at once, and again whenever an impact gives a body another path:
// the tree is built or refitted for a whole tick, and boxes only grow within it. BroadPhaseTree.h keeps its
// pairs from tick to tick, which pays where widened bounds hardly change.
//
// The order in which a query finds bodies depends on the whole scene; no result may depend on it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "physics/geometry/Vec2.h"

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
  /// same and its boxes have not spread too far, and rebuilds it otherwise.
  void update(const std::vector<SweptBox>& boxes, const std::vector<int>& ids, int id_count);

  const SweptBox& box(int id) const { return m_nodes[m_leaf_of[id]].box; }

  /// Enlarges the box of a body by `box`.
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

  /// Calls found(i, j), i < j, for every two bodies whose boxes overlap, once.
  template <typename Found>
  void queryPairs(Found&& found) const {
    if (m_nodes.empty()) return;
    std::pair<int, int> stack[4 * kDepth];  // what is left of each level: two of what one was divided into
    int height = 0;
    stack[height++] = {0, 0};
    while (height > 0) {
      const auto [a, b] = stack[--height];
      const Node &one = m_nodes[a], &other = m_nodes[b];
      if (a == b) {
        if (one.id >= 0) continue;
        stack[height++] = {one.first, one.first};
        stack[height++] = {one.second, one.second};
        if (overlaps(m_nodes[one.first].box, m_nodes[one.second].box)) {
          stack[height++] = {one.first, one.second};
        }
        continue;
      }
      if (one.id >= 0 && other.id >= 0) {
        one.id < other.id ? found(one.id, other.id) : found(other.id, one.id);
        continue;
      }
      const bool divides_one = other.id >= 0 || (one.id < 0 && sizeOf(one.box) > sizeOf(other.box));
      const Node& large = divides_one ? one : other;
      const SweptBox& box = divides_one ? other.box : one.box;
      const int rest = divides_one ? b : a;
      if (overlaps(m_nodes[large.first].box, box)) stack[height++] = {large.first, rest};
      if (overlaps(m_nodes[large.second].box, box)) stack[height++] = {large.second, rest};
    }
  }

 private:
  static double sizeOf(const SweptBox& box) { return (box.high.x - box.low.x) + (box.high.y - box.low.y); }
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
