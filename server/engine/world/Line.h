// A line segment, in world coordinates.
#pragma once

#include <string>

#include "Vector.h"

namespace df {

class Line {
 public:
  /// Makes a line from (0,0) to (0,0).
  Line() = default;
  Line(Vector init_p1, Vector init_p2) : m_p1(init_p1), m_p2(init_p2) {}

  /// The end points, in cells.
  void setP1(Vector new_p1) { m_p1 = new_p1; }
  Vector getP1() const { return m_p1; }
  void setP2(Vector new_p2) { m_p2 = new_p2; }
  Vector getP2() const { return m_p2; }

  /// Draws the line in the cells that it passes, with the character -, |, / or \ that fits its slope. A line
  /// longer than 1000 cells on an axis is not drawn.
  void draw() const;
  /// Returns "(x,y)-(x,y)".
  std::string toString() const { return m_p1.toString() + "-" + m_p2.toString(); }

 private:
  Vector m_p1;
  Vector m_p2;
};

}  // namespace df
