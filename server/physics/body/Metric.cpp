#include "physics/body/Metric.h"

#include <cmath>

namespace naiad::physics {

namespace {

constexpr double kOne = static_cast<double>(df::kFixedOne);

struct Parts {
  std::int64_t whole;
  double rest;
};

Parts partsOf(df::Fixed f) {
  const std::int64_t whole = (f + df::kFixedOne / 2) >> df::kFixedBits;
  return {whole, static_cast<double>(f - whole * df::kFixedOne) / kOne};
}

df::Fixed fixedOf(double whole, double rest) {
  return static_cast<df::Fixed>(whole) * df::kFixedOne + static_cast<df::Fixed>(std::llrint(rest * kOne));
}

}  // namespace

Place Metric::placeOf(df::FixedVector position) const {
  const Parts x = partsOf(position.x);
  const Parts y = partsOf(position.y);
  // The product is exact if the aspect has few digits. Place's + carries what exceeds half a unit.
  const double scaled = static_cast<double>(y.whole) * m_aspect;
  const double whole = df::math::rounded(scaled);
  return Place{x.whole, static_cast<std::int64_t>(whole), 0, 0} +
         Vec2{x.rest, (scaled - whole) + y.rest * m_aspect};
}

df::FixedVector Metric::fixedOf(const Place& place) const {
  const double whole = df::math::rounded(overAspect(static_cast<double>(place.cell_y)));
  const double left = static_cast<double>(place.cell_y) - whole * m_aspect;
  return {physics::fixedOf(static_cast<double>(place.cell_x), place.dx),
          physics::fixedOf(whole, overAspect(left + place.dy))};
}

bool Metric::isInRange(const Place& place) const {
  return std::abs(static_cast<double>(place.cell_x)) < df::kMaxCells &&
         std::abs(static_cast<double>(place.cell_y)) < df::kMaxCells * m_aspect;
}

Place Metric::placeAtCells(df::Vector position) const {
  return placeAt(fromCells(position));
}

df::Vector Metric::cellsOf(const Place& place) const {
  return toCells(place - Place{});
}

}  // namespace naiad::physics
