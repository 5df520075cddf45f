// A circle in world coordinates, in which to look for Objects (WM.objectsInCircle).
#pragma once

#include <string>

#include "Vector.h"

namespace df {

class Circle {
 public:
  /// Makes a circle at (0,0) with radius 0.
  Circle() = default;
  Circle(Vector init_center, float init_radius) : m_center(init_center), m_radius(init_radius) {}

  /// Centre, in cells.
  void setCenter(Vector new_center) { m_center = new_center; }
  Vector getCenter() const { return m_center; }
  /// Radius, in cells, equal on both axes.
  void setRadius(float new_radius) { m_radius = new_radius; }
  float getRadius() const { return m_radius; }

  /// Returns a text for log lines.
  std::string toString() const { return m_center.toString() + ", radius " + std::to_string(m_radius); }

 private:
  Vector m_center;
  float m_radius = 0;
};

}  // namespace df
