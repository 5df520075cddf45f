// A path through the world from node to node, as Object::pathTo() finds it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "Color.h"
#include "Vector.h"

namespace df {

class Path {
 public:
  /// Makes a path without nodes.
  Path() = default;

  /// Returns the next node to walk to; (-1,-1) for a path without nodes.
  Vector nextNode() const;
  /// Returns the node before nextNode(); (-1,-1) if that is the first node.
  Vector previousNode() const;
  /// The nodes; after setPath() the first node is next.
  void setPath(std::vector<Vector> new_path);
  const std::vector<Vector>& getPath() const { return m_path; }
  /// True if the next node is the last one, and for a path without nodes.
  bool endOfPath() const { return m_index + 1 >= static_cast<int>(m_path.size()); }
  /// Returns the last node; (-1,-1) for a path without nodes.
  Vector getEnd() const;
  /// Index of the next node. setIndex() returns 0, or -1 for an index without a node.
  int setIndex(int new_index);
  int getIndex() const { return m_index; }
  /// Advances to the next node, but not beyond the last one. Returns the path as it was before.
  Path operator++(int);
  /// Draws the remaining nodes. Returns 0, else -1.
  int draw(Color color) const;

  /// Returns a text for log lines.
  std::string toString() const;
  friend bool operator==(const Path& a, const Path& b) {
    return a.m_path == b.m_path && a.m_index == b.m_index;
  }
  friend bool operator!=(const Path& a, const Path& b) { return !(a == b); }

 private:
  std::vector<Vector> m_path;
  int m_index = 0;
};

}  // namespace df
