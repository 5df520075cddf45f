// The one tree of boxes: around what bodies sweep in a tick, or around their widened bounds (BroadPhase.h).
//
// The problem is all pairs of boxes at once, and what overlaps a single one: the tree is built or refitted
// for all of them, and then boxes only grow, as when an impact gives a body another path.
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
  /// same and its boxes have not spread too far, and rebuilds it otherwise. `values[i]`: a number of the
  /// caller's for that body, of which a node has the least of all below it; none: 0.
  void update(const std::vector<SweptBox>& boxes, const std::vector<int>& ids, int id_count,
              const std::vector<float>& values = {});

  const SweptBox& box(int id) const { return m_nodes[m_leaf_of[id]].box; }

  /// Enlarges the box of a body by `box`.
  void grow(int id, const SweptBox& box);

  /// What is below a node: one body or more.
  struct Below {
    const SweptBox& box;  // around all of theirs
    float least;          // of their values
    int bodies;
    int node;  // its number, until the next update()
  };

  /// Of every node, by its number: what joins(a, b) makes of ofBody(id) of all bodies below it.
  template <typename Summary, typename OfBody, typename Joins>
  void summarize(std::vector<Summary>& of_nodes, OfBody&& ofBody, Joins&& joins) const {
    of_nodes.resize(m_nodes.size());
    for (int i = size(); i-- > 0;) {
      const int id = m_nodes[i].id;
      of_nodes[i] = id >= 0 ? ofBody(id) : joins(of_nodes[i + 1], of_nodes[secondOf(i)]);
    }
  }

  /// Goes down from the top, and below a node if enters(Below) says so; calls found(id) for every body that
  /// it comes to. What is near the body `beside` comes first, if it is not below 0.
  template <typename Enters, typename Found>
  void walk(Enters&& enters, Found&& found, int beside = -1) const {
    const int near = beside < 0 ? size() : nodeOfMany(m_leaf_of[beside]);
    const auto walkThrough = [&](int begin, int end) {
      for (int i = begin; i < end;) {
        if (i == near && begin != near) {
          i = m_nodes[i].end;
          continue;
        }
        const Node& node = m_nodes[i];
        if (!enters(below(i))) {
          i = node.end;
          continue;
        }
        ++i;
        if (node.id >= 0) found(node.id);
      }
    };
    if (near < size()) walkThrough(near, m_nodes[near].end);
    if (near > 0) walkThrough(0, size());
  }

  /// Calls found(id) for every body whose box overlaps `box`. If it returns false, that was the last one.
  template <typename Found>
  void query(const SweptBox& box, Found&& found) const {
    for (int i = 0; i < size();) {
      const Node& node = m_nodes[i];
      if (!overlaps(node.box, box)) {
        i = node.end;
        continue;
      }
      ++i;
      if (node.id < 0) continue;
      if constexpr (std::is_void_v<decltype(found(node.id))>) {
        found(node.id);
      } else if (!found(node.id)) {
        return;
      }
    }
  }

  /// Calls found(i, j), i < j, for every two bodies whose boxes overlap, once. A few bodies that are side by
  /// side are asked for together.
  template <typename Found>
  void queryPairs(Found&& found) {
    queryPairs(std::forward<Found>(found), [](const Below& /*below*/) { return false; });
  }
  /// The same without the bodies below nodes of which skips(Below) is true: these are in no pair.
  template <typename Found, typename Skips>
  void queryPairs(Found&& found, Skips&& skips) {
    for (int i = 0; i < size();) {
      const Node& few = m_nodes[i];
      if (skips(below(i))) {
        i = few.end;
        continue;
      }
      if (few.end - i > kNodesOfFew) {
        ++i;
        continue;
      }
      m_near.clear();  // those of the few come first
      for (int k = i; k < size();) {
        const Node& node = m_nodes[k];
        const bool overlapping = overlaps(node.box, few.box) && !skips(below(k));
        if (overlapping && node.id >= 0) m_near.push_back({node.box, node.id});
        k = overlapping ? k + 1 : node.end;
      }
      const int own = (few.end - i + 1) / 2;
      for (int k = 0; k < own; ++k) {
        const Leaf one = m_near[k];
        for (std::size_t l = k + 1; l < m_near.size(); ++l) {
          const Leaf& other = m_near[l];
          if (!overlaps(one.box, other.box)) continue;
          one.id < other.id ? found(one.id, other.id) : found(other.id, one.id);
        }
      }
      i = few.end;
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
      const int first = m_member[node + 1], second = m_member[secondOf(node)];
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
        const int first = a + 1, second = secondOf(a);
        if (overlaps(m_nodes[first].box, m_nodes[second].box)) stack[height++] = {first, second};
        stack[height++] = {first, first};
        stack[height++] = {second, second};
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
  static constexpr int kDepth = 128;      // halved at every level: far more than any number of bodies needs
  static constexpr int kNodesOfFew = 15;  // eight bodies and what is above them
  static constexpr int kNodesOfMany = 255;
  struct Node {  // its first child is the next one
    SweptBox box;
    int parent;
    int id;   // of the leaf's body; −1 above
    int end;  // the first node that is not below it
    float least;
  };
  struct Leaf {
    SweptBox box;
    int id;
  };
  int size() const { return static_cast<int>(m_nodes.size()); }
  int secondOf(int node) const { return m_nodes[node + 1].end; }
  Below below(int node) const {
    return {m_nodes[node].box, m_nodes[node].least, (m_nodes[node].end - node + 1) / 2, node};
  }
  // The first one above with so many below it, or the top.
  int nodeOfMany(int node) const {
    while (m_nodes[node].end - node < kNodesOfMany && m_nodes[node].parent >= 0) node = m_nodes[node].parent;
    return node;
  }

  // Of two nodes the larger one is divided.
  void divide(int a, int b, std::pair<int, int>* stack, int& height) const {
    const Node &one = m_nodes[a], &other = m_nodes[b];
    const bool divides_one = other.id >= 0 || (one.id < 0 && sizeOf(one.box) > sizeOf(other.box));
    const SweptBox& box = divides_one ? other.box : one.box;
    const int large = divides_one ? a : b, rest = divides_one ? b : a;
    for (const int child : {large + 1, secondOf(large)}) {
      if (overlaps(m_nodes[child].box, box)) stack[height++] = {child, rest};
    }
  }
  void build(int begin, int end, int parent);
  double refit();

  std::vector<Node> m_nodes;
  std::vector<int> m_leaf_of;
  std::vector<int> m_ids;  // of the last build, as given
  std::vector<int> m_order;
  std::vector<int> m_member;                       // by node, during queryGroups()
  std::vector<Leaf> m_near;                        // during queryPairs()
  const std::vector<SweptBox>* m_boxes = nullptr;  // during update()
  double m_built_size = 0;
};

}  // namespace naiad::physics
