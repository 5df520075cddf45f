// A tree of boxes: those that enclose the paths of bodies in a tick, or widened bounds (BroadPhase.h).
//
// Finds all pairs of boxes at once, or all boxes that overlap a single one. The tree is built or refitted for
// all boxes. After that boxes only grow, for example when an impact gives a body another path.
//
// Queries find bodies in an order that depends on the whole scene; no result of the caller may depend on it.
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

/// A tree with one leaf per body. The cost is n·log n to build, n to refit, about log n to query or to
/// enlarge a leaf. Keeps its memory.
class ImpactTree {
 public:
  /// Sets `boxes[i]` for the bodies `ids[i]`, all below `id_count`. Refits the old tree if the ids are
  /// unchanged and its boxes have not spread too far; otherwise rebuilds it. `values[i]` is any number for
  /// each body (0 if omitted); a node has the minimum of those below it.
  void update(const std::vector<SweptBox>& boxes, const std::vector<int>& ids, int id_count,
              const std::vector<float>& values = {});

  const SweptBox& box(int id) const { return m_nodes[m_leaf_of[id]].box; }

  /// Enlarges the box of a body by `box`.
  void grow(int id, const SweptBox& box);

  /// The bodies below a node; at least one body.
  struct Below {
    const SweptBox& box;  // box around the boxes of all these bodies
    float least;          // minimum of the bodies' values
    int bodies;
    int node;  // index of the node, valid until the next update()
  };

  /// Sets of_nodes for every node: ofBody(id) for a leaf, joins(a, b) of its children's values otherwise.
  template <typename Summary, typename OfBody, typename Joins>
  void summarize(std::vector<Summary>& of_nodes, OfBody&& ofBody, Joins&& joins) const {
    of_nodes.resize(m_nodes.size());
    for (int i = size(); i-- > 0;) {
      const int id = m_nodes[i].id;
      of_nodes[i] = id >= 0 ? ofBody(id) : joins(of_nodes[i + 1], of_nodes[secondOf(i)]);
    }
  }

  /// Descends from the root into nodes for which enters(Below) is true, and calls found(id) for every body
  /// reached. If `beside` is a body, bodies near it come first; −1: none.
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

  /// Calls found(id) for every body whose box overlaps `box`. Stops if found() returns false.
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

  /// Calls found(i, j), i < j, once for every two overlapping bodies. Queries small groups together.
  template <typename Found>
  void queryPairs(Found&& found) {
    queryPairs(std::forward<Found>(found), [](const Below& /*below*/) { return false; });
  }
  /// Like queryPairs(), without the bodies below nodes for which skips(Below) is true.
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
      m_near.clear();  // the bodies of the small group come first
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

  /// Like queryPairs(), for grouping: skips pairs within groups that are already known. For bodies in one
  /// place it finds about as many pairs as bodies. areOne(i, j) is true if the groups of i and j need no
  /// further pairs between them. Once true it must stay true, and it may depend only on pairs found before.
  template <typename Found, typename AreOne>
  void queryGroups(Found&& found, AreOne&& areOne) {
    if (m_nodes.empty()) return;
    m_member.clear();
    for (const Node& node : m_nodes) m_member.push_back(node.id);
    // Returns one of the bodies below a node if all belong to one group; −1 if not, or not known yet.
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
        // This pair is processed last, when all bodies below each child may have become one group.
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
  static constexpr int kDepth = 128;      // levels; each halves the bodies, so this is far more than needed
  static constexpr int kNodesOfFew = 15;  // number of nodes for eight bodies: leaves and inner nodes
  static constexpr int kNodesOfMany = 255;
  struct Node {  // the first child of a node is the next node
    SweptBox box;
    int parent;
    int id;   // body of a leaf; −1 for inner nodes
    int end;  // index after the last node of its subtree
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
  // Returns the lowest ancestor with at least kNodesOfMany nodes in its subtree, or the root.
  int nodeOfMany(int node) const {
    while (m_nodes[node].end - node < kNodesOfMany && m_nodes[node].parent >= 0) node = m_nodes[node].parent;
    return node;
  }

  // Replaces the larger of two nodes, or the only one that has children, by its children.
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
  std::vector<int> m_ids;  // ids of the last build, in the caller's order
  std::vector<int> m_order;
  std::vector<int> m_member;  // by node: result of memberOf(); only valid during queryGroups()
  std::vector<Leaf> m_near;   // bodies near the small group; only valid during queryPairs()
  const std::vector<SweptBox>* m_boxes = nullptr;  // argument of update(); only valid during it
  double m_built_size = 0;
};

}  // namespace naiad::physics
