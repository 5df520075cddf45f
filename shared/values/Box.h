// An axis-aligned rectangle in cells (book, section 4.13): an Object's bounding box, a view, a boundary.
#pragma once

#include "Vector.h"

namespace df {

class Box {
 public:
  /// Makes a box with corner (0,0) and size 0 by 0.
  Box() = default;
  /// Makes a box with upper left `corner`, `horizontal` cells wide and `vertical` cells high (both >= 0).
  Box(Vector corner, double horizontal, double vertical)
      : m_corner(corner), m_horizontal(horizontal), m_vertical(vertical) {}

  /// Upper left corner, in cells. In an Object's box, relative to its position.
  void setCorner(Vector corner) { m_corner = corner; }
  Vector getCorner() const { return m_corner; }
  /// Width, in cells.
  void setHorizontal(double horizontal) { m_horizontal = horizontal; }
  float getHorizontal() const { return static_cast<float>(m_horizontal); }
  /// Height, in cells.
  void setVertical(double vertical) { m_vertical = vertical; }
  float getVertical() const { return static_cast<float>(m_vertical); }
  /// The sizes in double precision.
  double width() const { return m_horizontal; }
  double height() const { return m_vertical; }

  /// Returns corner, horizontal and vertical size as "(x,y),horizontal,vertical".
  std::string toString() const;

  friend bool operator==(const Box& a, const Box& b) {
    return a.m_corner == b.m_corner && a.m_horizontal == b.m_horizontal && a.m_vertical == b.m_vertical;
  }
  friend bool operator!=(const Box& a, const Box& b) { return !(a == b); }

 private:
  Vector m_corner;
  double m_horizontal = 0;
  double m_vertical = 0;
};

#if __cplusplus >= 201703L
/// Returns the box in fixed point; nullopt if a number is not finite, a size is negative, the corner is
/// beyond 1e6 cells or a size beyond `size_limit` cells.
std::optional<FixedBox> toFixed(const Box& box, double size_limit = 1e6);
#endif

/// Converts a fixed-point box.
Box fromFixed(const FixedBox& box);

}  // namespace df
