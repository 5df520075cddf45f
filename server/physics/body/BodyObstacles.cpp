#include "physics/body/BodyObstacles.h"

#include <algorithm>

namespace naiad::physics {

namespace {

// Converts a place to a position in the world, clamped to the range of positions.
FixedVector clamped(const Metric& metric, const Place& place) {
  if (metric.isInRange(place)) return metric.fixedOf(place);
  const Vector at = metric.cellsOf(place);
  const auto clamp = [](double x) { return std::clamp(x, -df::kMaxCells, df::kMaxCells); };
  return *toFixed(Vector(clamp(at.x()), clamp(at.y())));
}

}  // namespace

void BodyObstacles::beginTick() {
  for (Obstacle& obstacle : m_all) obstacle.is_near = false;
}

void BodyObstacles::markNear(ObjectKey key) {
  const auto at =
      std::lower_bound(m_all.begin(), m_all.end(), key,
                       [](const Obstacle& obstacle, ObjectKey k) { return obstacle.key.slot < k.slot; });
  if (at == m_all.end() || at->key.slot != key.slot) {
    m_all.insert(at, Obstacle{key});
    return;
  }
  at->key = key;  // if a new Object has taken the slot, the solver keeps its obstacle and only moves it
  at->is_near = true;
}

FixedBox regionOf(const Metric& metric, const Place& centre, Vec2 half) {
  constexpr double kFarthest = 1 << 28;  // metric cells to either side, so that the box's size is in range
  const Vec2 reach = {std::min(half.x, kFarthest), std::min(half.y, kFarthest)};
  const FixedVector low = clamped(metric, centre + -reach), high = clamped(metric, centre + reach);
  return {{low.x - 1, low.y - 1}, {high.x - low.x + 2, high.y - low.y + 2}};
}

}  // namespace naiad::physics
