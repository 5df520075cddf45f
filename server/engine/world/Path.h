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
  /// Without nodes.
  Path() = default;

  /// The node to go to next; (-1,-1) if there is none.
  Vector nextNode() const;
  /// The node before it; (-1,-1) if there is none.
  Vector previousNode() const;
  /// New nodes; the first one is next.
  void setPath(std::vector<Vector> new_path);
  const std::vector<Vector>& getPath() const { return m_path; }
  /// True at the last node, and without any.
  bool endOfPath() const { return m_index + 1 >= static_cast<int>(m_path.size()); }
  /// The last node; (-1,-1) if there is none.
  Vector getEnd() const;
  /// Which node is next. Return 0, or -1 for a number without one.
  int setIndex(int new_index);
  int getIndex() const { return m_index; }
  /// On to the next node; at the last one it stays. Returns the path as it was.
  Path operator++(int);
  /// Draw the nodes that are left. Return 0, else -1.
  int draw(Color color) const;

  /// For log lines.
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
