// The broad phase of bodies that do not turn: a tree of boxes, each around what a body sweeps in a tick.
//
// The problem is all pairs of swept boxes at once, and again whenever an impact gives a body another path:
// the tree is built or refitted for a whole tick, and boxes only grow within it. BroadPhaseTree.h keeps its
// pairs from tick to tick, which pays where widened bounds hardly change.
//
// The order in which a query finds bodies depends on the whole scene; no result may depend on it.
#pragma once

#include <cstdint>
#include <type_traits>
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

  /// Calls found(id) for every body whose box overlaps `box`. If it returns false, that was the last one.
  template <typename Found>
  void query(const SweptBox& box, Found&& found) const {
    if (m_nodes.empty() || !overlaps(m_nodes[0].box, box)) return;
    int stack[kDepth];
    int height = 0;
    stack[height++] = 0;
    while (height > 0) {
      const Node& node = m_nodes[stack[--height]];
      if (node.id >= 0) {
        if constexpr (std::is_void_v<decltype(found(node.id))>) {
          found(node.id);
        } else if (!found(node.id)) {
          return;
        }
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
      divide(a, b, stack, height);
    }
  }

  /// The same for those who ask what hangs together, but no pairs within what is known to: of bodies in one
  /// place it finds about as many pairs as bodies. areOne(i, j): do i and j hang together, so that no pair
  /// between what hangs together with i and with j is of interest? Once true it stays so, and follows from
  /// the pairs found before.
  template <typename Found, typename AreOne>
  void queryGroups(Found&& found, AreOne&& areOne) {
    if (m_nodes.empty()) return;
    m_member.clear();
    for (const Node& node : m_nodes) m_member.push_back(node.id);
    // One of the bodies below a node, if all of them are one; −1: they are not, or it is not known yet.
    const auto memberOf = [&](int node) {
      int& member = m_member[node];
      if (member >= 0) return member;
      const int first = m_member[m_nodes[node].first], second = m_member[m_nodes[node].second];
      if (first >= 0 && second >= 0 && areOne(first, second)) member = first;
      return member;
    };
    std::pair<int, int> stack[6 * kDepth];
    int height = 0;
    stack[height++] = {0, 0};
    while (height > 0) {
      const auto [a, b] = stack[--height];
      const Node &one = m_nodes[a], &other = m_nodes[b];
      if (a == b) {
        if (one.id >= 0) continue;
        // The two against each other at last, when each may have become one.
        if (overlaps(m_nodes[one.first].box, m_nodes[one.second].box)) {
          stack[height++] = {one.first, one.second};
        }
        stack[height++] = {one.first, one.first};
        stack[height++] = {one.second, one.second};
        continue;
      }
      const int i = memberOf(a), j = memberOf(b);
      if (i >= 0 && j >= 0 && areOne(i, j)) continue;
      if (one.id >= 0 && other.id >= 0) {
        i < j ? found(i, j) : found(j, i);
        continue;
      }
      divide(a, b, stack, height);
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

  // Of two nodes the larger one is divided.
  void divide(int a, int b, std::pair<int, int>* stack, int& height) const {
    const Node &one = m_nodes[a], &other = m_nodes[b];
    const bool divides_one = other.id >= 0 || (one.id < 0 && sizeOf(one.box) > sizeOf(other.box));
    const Node& large = divides_one ? one : other;
    const SweptBox& box = divides_one ? other.box : one.box;
    const int rest = divides_one ? b : a;
    if (overlaps(m_nodes[large.first].box, box)) stack[height++] = {large.first, rest};
    if (overlaps(m_nodes[large.second].box, box)) stack[height++] = {large.second, rest};
  }
  int build(int begin, int end, int parent);
  double refit();

  std::vector<Node> m_nodes;
  std::vector<int> m_leaf_of;
  std::vector<int> m_ids;  // of the last build, as given
  std::vector<int> m_order;
  std::vector<int> m_member;                       // by node, during queryGroups()
  const std::vector<SweptBox>* m_boxes = nullptr;  // during update()
  double m_built_size = 0;
};

}  // namespace naiad::physics
