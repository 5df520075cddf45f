#include "engine/world/Line.h"

#include <algorithm>
#include <cmath>

#include "engine/world/Drawing.h"

namespace df {

void Line::draw() const {
  constexpr double kMaxLength = 1000;
  const Vector displacement = m_p2 - m_p1;
  const double length = std::max(std::fabs(displacement.x()), std::fabs(displacement.y()));
  if (!(length <= kMaxLength)) return;
  const bool flat = std::fabs(displacement.y()) * 2 <= std::fabs(displacement.x());
  const bool steep = std::fabs(displacement.x()) * 2 <= std::fabs(displacement.y());
  const char ch = flat ? '-' : steep ? '|' : (displacement.x() > 0) == (displacement.y() > 0) ? '\\' : '/';
  const int steps = static_cast<int>(std::ceil(length));
  for (int i = 0; i <= steps; ++i) {
    const double part = steps == 0 ? 0 : static_cast<double>(i) / steps;
    drawCharacter(Vector(m_p1.x() + part * displacement.x(), m_p1.y() + part * displacement.y()), ch,
                  COLOR_DEFAULT);
  }
}

}  // namespace df
