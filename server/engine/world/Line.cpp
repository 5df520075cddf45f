#include "engine/world/Line.h"

#include <algorithm>
#include <cmath>

#include "engine/world/Drawing.h"

namespace df {

void Line::draw() const {
  constexpr double kLongest = 1000;
  const Vector way = m_p2 - m_p1;
  const double length = std::max(std::fabs(way.x()), std::fabs(way.y()));
  if (!(length <= kLongest)) return;
  const bool flat = std::fabs(way.y()) * 2 <= std::fabs(way.x());
  const bool steep = std::fabs(way.x()) * 2 <= std::fabs(way.y());
  const char ch = flat ? '-' : steep ? '|' : (way.x() > 0) == (way.y() > 0) ? '\\' : '/';
  const int steps = static_cast<int>(std::ceil(length));
  for (int i = 0; i <= steps; ++i) {
    const double part = steps == 0 ? 0 : static_cast<double>(i) / steps;
    drawCharacter(Vector(m_p1.x() + part * way.x(), m_p1.y() + part * way.y()), ch, COLOR_DEFAULT);
  }
}

}  // namespace df
