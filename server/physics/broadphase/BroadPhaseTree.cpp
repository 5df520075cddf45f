#include "physics/broadphase/BroadPhaseTree.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "physics/geometry/Reserve.h"
namespace naiad::physics {

std::int32_t BroadPhaseTree::allocate() {
  if (m_free == kNone) {
    m_nodes.push_back({});
    return static_cast<std::int32_t>(m_nodes.size()) - 1;
  }
  const std::int32_t i = m_free;
  m_free = node(i).parent;
  return i;
}

void BroadPhaseTree::release(std::int32_t i) {
  node(i).parent = m_free;
  m_free = i;
}

std::int32_t BroadPhaseTree::insert(const GridBounds& bounds, std::uint32_t value) {
  const std::int32_t leaf = allocate();
  node(leaf) = {bounds, kNone, {kNone, kNone}, value};
  attach(leaf);
  return leaf;
}

void BroadPhaseTree::remove(std::int32_t leaf) {
  assert(node(leaf).isLeaf());
  detach(leaf);
  if (m_spare != kNone) release(m_spare);
  m_spare = kNone;
  release(leaf);
}

void BroadPhaseTree::move(std::int32_t leaf, const GridBounds& bounds) {
  assert(node(leaf).isLeaf());
  detach(leaf);
  node(leaf).bounds = bounds;
  attach(leaf);
}

void BroadPhaseTree::rebuild(std::span<const Leaf> of, std::span<std::int32_t> leaves) {
  m_nodes.clear();
  m_root = m_free = m_spare = kNone;
  reserveFor(m_nodes, 2 * of.size());
  m_middles.clear();
  reserveFor(m_middles, of.size());
  for (const Leaf& leaf : of) {
    const GridBounds& b = leaf.bounds;
    m_middles.push_back(
        {b.lower_x + b.upper_x, b.lower_y + b.upper_y, static_cast<std::int32_t>(m_middles.size())});
  }
  if (!of.empty()) m_root = build(m_middles, kNone, of, leaves);
}

// Depth first, so that what is near in the tree is near in memory. Halves bound the depth.
std::int32_t BroadPhaseTree::build(std::span<Middle> middles, std::int32_t parent, std::span<const Leaf> of,
                                   std::span<std::int32_t> leaves) {
  const auto made = static_cast<std::int32_t>(m_nodes.size());
  if (middles.size() == 1) {
    const std::int32_t i = middles[0].index;
    const Leaf& leaf = of[index(i)];
    m_nodes.push_back({leaf.bounds, parent, {kNone, kNone}, leaf.value});
    return leaves[index(i)] = made;
  }
  m_nodes.push_back({{}, parent, {kNone, kNone}, 0});
  std::int64_t low_x = middles[0].x, high_x = low_x, low_y = middles[0].y, high_y = low_y;
  for (const Middle& m : middles) {
    low_x = std::min(low_x, m.x), high_x = std::max(high_x, m.x);
    low_y = std::min(low_y, m.y), high_y = std::max(high_y, m.y);
  }
  const auto half = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
  if (high_x - low_x >= high_y - low_y) {
    std::nth_element(middles.begin(), half, middles.end(), [](const Middle& a, const Middle& b) {
      return a.x != b.x ? a.x < b.x : a.index < b.index;
    });
  } else {
    std::nth_element(middles.begin(), half, middles.end(), [](const Middle& a, const Middle& b) {
      return a.y != b.y ? a.y < b.y : a.index < b.index;
    });
  }
  const std::int32_t first = build({middles.begin(), half}, made, of, leaves);
  const std::int32_t second = build({half, middles.end()}, made, of, leaves);
  Node& n = node(made);
  n.child[0] = first;
  n.child[1] = second;
  n.bounds = unite(node(first).bounds, node(second).bounds);
  return made;
}

// Goes down where the growth of everything passed is least, and stops where a new pair would cost no more.
std::int32_t BroadPhaseTree::bestSibling(const GridBounds& bounds) const {
  std::int32_t current = m_root, best = m_root;
  std::int64_t inherited = 0, best_cost = perimeter(unite(node(m_root).bounds, bounds));
  const std::int64_t own = perimeter(bounds);
  while (!node(current).isLeaf()) {
    const Node& here = node(current);
    inherited += perimeter(unite(here.bounds, bounds)) - perimeter(here.bounds);
    std::int64_t lowest = 0, tie = 0;
    std::int32_t down = kNone;
    for (const std::int32_t child : here.child) {
      const GridBounds& of_child = node(child).bounds;
      const std::int64_t direct = perimeter(unite(of_child, bounds)), cost = direct + inherited;
      if (cost < best_cost) best_cost = cost, best = child;
      const std::int64_t grown = direct - perimeter(of_child);
      // The least cost of any place below this child; the distance of the middles decides between equal ones.
      const std::int64_t bound = node(child).isLeaf() ? cost : inherited + grown + own;
      const std::int64_t far =
          std::abs(of_child.lower_x + of_child.upper_x - bounds.lower_x - bounds.upper_x) +
          std::abs(of_child.lower_y + of_child.upper_y - bounds.lower_y - bounds.upper_y);
      if (down == kNone || bound < lowest || (bound == lowest && far < tie))
        lowest = bound, tie = far, down = child;
    }
    if (node(down).isLeaf() || lowest >= best_cost) break;
    current = down;
  }
  return best;
}

void BroadPhaseTree::replaceChild(std::int32_t parent, std::int32_t old_child, std::int32_t new_child) {
  if (parent == kNone) {
    m_root = new_child;
  } else {
    Node& p = node(parent);
    p.child[p.child[0] == old_child ? 0 : 1] = new_child;
  }
  node(new_child).parent = parent;
}

void BroadPhaseTree::attach(std::int32_t leaf) {
  if (m_root == kNone) {
    m_root = leaf;
    node(leaf).parent = kNone;
    return;
  }
  const std::int32_t sibling = bestSibling(node(leaf).bounds);
  const std::int32_t joint = m_spare != kNone ? m_spare : allocate();
  m_spare = kNone;
  replaceChild(node(sibling).parent, sibling, joint);
  node(joint).child[0] = sibling;
  node(joint).child[1] = leaf;
  node(sibling).parent = node(leaf).parent = joint;
  refitUpwards(joint);
}

void BroadPhaseTree::detach(std::int32_t leaf) {
  const std::int32_t joint = node(leaf).parent;
  if (joint == kNone) {
    m_root = kNone;
    return;
  }
  const std::int32_t sibling = node(joint).child[node(joint).child[0] == leaf ? 1 : 0];
  const std::int32_t above = node(joint).parent;
  replaceChild(above, joint, sibling);
  m_spare = joint;
  for (std::int32_t i = above; i != kNone; i = node(i).parent) {
    const GridBounds fit = unite(node(node(i).child[0]).bounds, node(node(i).child[1]).bounds);
    if (fit == node(i).bounds) break;
    node(i).bounds = fit;
  }
}

void BroadPhaseTree::refitUpwards(std::int32_t i) {
  for (; i != kNone; i = node(i).parent) {
    node(i).bounds = unite(node(node(i).child[0]).bounds, node(node(i).child[1]).bounds);
    rotate(i);
  }
}

// A child and one of the other child's children change places, whichever swap shrinks the other child most.
void BroadPhaseTree::rotate(std::int32_t i) {
  std::int64_t best = 0;
  int best_side = 0, best_niece = 0;
  for (int side = 0; side < 2; ++side) {
    const Node& child = node(node(i).child[side]);
    const Node& other = node(node(i).child[1 - side]);
    if (other.isLeaf()) continue;
    const std::int64_t now = perimeter(other.bounds);
    for (int niece = 0; niece < 2; ++niece) {
      const std::int64_t gain = now - perimeter(unite(child.bounds, node(other.child[1 - niece]).bounds));
      if (gain > best) best = gain, best_side = side, best_niece = niece;
    }
  }
  if (best == 0) return;
  const std::int32_t child = node(i).child[best_side], other = node(i).child[1 - best_side];
  const std::int32_t niece = node(other).child[best_niece];
  node(i).child[best_side] = niece;
  node(niece).parent = i;
  node(other).child[best_niece] = child;
  node(child).parent = other;
  node(other).bounds = unite(node(node(other).child[0]).bounds, node(node(other).child[1]).bounds);
}

std::int32_t BroadPhaseTree::height() const {
  if (m_root == kNone) return 0;
  std::vector<std::pair<std::int32_t, std::int32_t>> left = {{m_root, 1}};
  std::int32_t highest = 0;
  while (!left.empty()) {
    const auto [i, depth] = left.back();
    left.pop_back();
    highest = std::max(highest, depth);
    if (node(i).isLeaf()) continue;
    for (const std::int32_t child : node(i).child) left.emplace_back(child, depth + 1);
  }
  return highest;
}

bool BroadPhaseTree::isSound() const {
  if (m_root == kNone) return true;
  if (node(m_root).parent != kNone) return false;
  std::vector<std::int32_t> left = {m_root};
  while (!left.empty()) {
    const std::int32_t i = left.back();
    left.pop_back();
    if (node(i).isLeaf()) continue;
    for (const std::int32_t child : node(i).child) {
      if (node(child).parent != i) return false;
      left.push_back(child);
    }
    if (node(i).bounds != unite(node(node(i).child[0]).bounds, node(node(i).child[1]).bounds)) return false;
  }
  return true;
}

}  // namespace naiad::physics
