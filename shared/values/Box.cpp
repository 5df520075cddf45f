#include "shared/values/Box.h"

namespace df {

std::string Box::toString() const {
  return m_corner.toString() + "," + std::to_string(m_horizontal) + "," + std::to_string(m_vertical);
}

std::optional<FixedBox> toFixed(const Box& box, double size_limit) {
  const auto corner = toFixed(box.getCorner(), 1e6);
  const auto size = toFixed(Vector(box.width(), box.height()), size_limit);
  if (!corner || !size || size->x < 0 || size->y < 0) return std::nullopt;
  return FixedBox{*corner, *size};
}

Box fromFixed(const FixedBox& box) {
  return {Vector::fromFixed(box.corner), toCells(box.size.x), toCells(box.size.y)};
}

}  // namespace df
