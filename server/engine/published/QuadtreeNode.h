// A node of the tree in which the published engine keeps Objects by their positions. Naiad's world has a grid
// instead, so this node is only a list of Objects with a boundary and never splits.
#pragma once

#include <string>

#include "Box.h"
#include "Object.h"
#include "ObjectList.h"
#include "Vector.h"

namespace df {

inline constexpr int QUADTREE_THRESH_DEFAULT = 1;
inline constexpr int QUADTREE_MAX_DEPTH = 10;

class QuadtreeNode {
 public:
  QuadtreeNode(QuadtreeNode* /*p_parent*/, int depth, Box boundary) : m_depth(depth), m_boundary(boundary) {}

  ObjectList getObjects() const { return m_objects; }
  Box getBoundary() const { return m_boundary; }
  int getDepth() const { return m_depth; }
  /// Add or remove an Object. Return 0, else -1.
  int insertObject(Object* p_o) { return m_objects.insert(p_o); }
  int removeObject(Object* p_o) { return m_objects.remove(p_o); }
  int split() { return 0; }
  QuadtreeNode* findOwner(Object* /*p_o*/) { return this; }
  QuadtreeNode* findOwner(Object* /*p_o*/, Vector /*where*/) { return this; }
  QuadtreeNode* findOwner(Object* /*p_o*/, Box /*box*/) { return this; }
  /// See WM.getCollisions().
  ObjectList getCollisions(Object* p_o, Vector where) const;
  std::string toString() const;

 private:
  int m_depth;
  Box m_boundary;
  ObjectList m_objects;
};

}  // namespace df
