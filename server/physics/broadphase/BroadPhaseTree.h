// A dynamic tree of bounds: finds what overlaps a box, for bodies that come, go and move one by one.
//
// Leaves are inserted where they enlarge the tree least; then, up to the root, a node and its niece change
// places if that makes the tree smaller (surface area heuristic; cf. E. Catto, "Dynamic bounding volume
// hierarchies", 2019). Its form follows from the order of calls alone. Memory is kept, never given back.
//
// The problem is to keep the pairs of a scene that hardly changes: a RigidWorld's bodies, with widened bounds
// in whole numbers. ImpactTree.h is rebuilt from all the swept boxes of a tick instead; the world's grid
// (engine/collision) knows Objects' boxes in cells, not bodies' bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/broadphase/BroadPhaseBounds.h"

namespace naiad::physics {

/// One thread at a time, for queries too: they share a stack.
class BroadPhaseTree {
 public:
  static constexpr std::int32_t kNone = -1;

  /// Returns the leaf's number, good until it is removed. `value` is what queries report.
  std::int32_t insert(const GridBounds& bounds, std::uint32_t value);
  void remove(std::int32_t leaf);
  /// The leaf keeps its number.
  void move(std::int32_t leaf, const GridBounds& bounds);

  /// A tree of these leaves alone, divided in halves: what n insertions do, in a quarter of the time. Leaves
  /// get other numbers, which are written to `leaves`.
  struct Leaf {
    GridBounds bounds;
    std::uint32_t value;
  };
  void rebuild(std::span<const Leaf> of, std::span<std::int32_t> leaves);

  const GridBounds& bounds(std::int32_t leaf) const { return m_nodes[index(leaf)].bounds; }
  std::uint32_t value(std::int32_t leaf) const { return m_nodes[index(leaf)].value; }

  /// Calls visit(value) for every leaf that overlaps, in an order that depends only on the calls before.
  template <class Visit>
  void query(const GridBounds& bounds, Visit&& visit) const;

  /// Are all invariants kept? For tests: it visits every node.
  bool isSound() const;
  std::int32_t height() const;

 private:
  struct Node {
    GridBounds bounds;
    std::int32_t parent;    // or the next free node
    std::int32_t child[2];  // kNone, kNone: a leaf
    std::uint32_t value;
    bool isLeaf() const { return child[0] == kNone; }
  };

  static std::size_t index(std::int32_t node) { return static_cast<std::size_t>(node); }
  Node& node(std::int32_t i) { return m_nodes[index(i)]; }
  const Node& node(std::int32_t i) const { return m_nodes[index(i)]; }
  std::int32_t allocate();
  void release(std::int32_t i);
  void attach(std::int32_t leaf);
  void detach(std::int32_t leaf);
  std::int32_t bestSibling(const GridBounds& bounds) const;
  void replaceChild(std::int32_t parent, std::int32_t old_child, std::int32_t new_child);
  void refitUpwards(std::int32_t i);
  void rotate(std::int32_t i);
  struct Middle {  // of a leaf, times two
    std::int64_t x, y;
    std::int32_t index;
  };
  std::int32_t build(std::span<Middle> middles, std::int32_t parent, std::span<const Leaf> of,
                     std::span<std::int32_t> leaves);

  std::vector<Node> m_nodes;
  std::int32_t m_root = kNone;
  std::int32_t m_free = kNone;
  std::int32_t m_spare = kNone;  // the inner node that a leaf keeps while it is moved
  mutable std::vector<std::int32_t> m_stack;
  std::vector<Middle> m_middles;
};

template <class Visit>
void BroadPhaseTree::query(const GridBounds& bounds, Visit&& visit) const {
  if (m_root == kNone) return;
  m_stack.clear();
  std::int32_t current = m_root;
  if (!overlap(node(current).bounds, bounds)) return;
  for (;;) {
    const Node& here = node(current);
    if (here.isLeaf()) {
      visit(here.value);
    } else {
      const bool first = overlap(node(here.child[0]).bounds, bounds);
      const bool second = overlap(node(here.child[1]).bounds, bounds);
      if (first && second) m_stack.push_back(here.child[1]);
      if (first || second) {
        current = here.child[first ? 0 : 1];
        continue;
      }
    }
    if (m_stack.empty()) return;
    current = m_stack.back();
    m_stack.pop_back();
  }
}

}  // namespace naiad::physics
