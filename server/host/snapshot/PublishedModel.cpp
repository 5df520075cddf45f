#include "host/snapshot/PublishedModel.h"

#include <algorithm>
#include <cstdlib>

namespace naiad {

namespace {

/// The reach of a view object, so large that the object is of interest to every client, wherever the view is.
constexpr std::int32_t kOnEveryView = 1 << 20;

/// Returns an upper bound of the cells that a motion covers in `ticks`.
std::int64_t cellsCovered(df::Fixed velocity, df::Fixed acceleration, std::int64_t ticks) {
  constexpr std::int64_t kFar = 1 << 30;
  constexpr std::int64_t kFine = df::kFixedOne >> 8;
  if (velocity == 0 && acceleration == 0) return 0;
  const std::int64_t speed = (std::abs(velocity) + ticks * std::abs(acceleration) + kFine - 1) / kFine;
  return std::min(kFar, (speed * ticks >> 8) + 1);
}

}  // namespace

std::int32_t reachOf(const PublishedModel& model) {
  if (!model.alive) return 0;
  if (model.state.body.on_view) return kOnEveryView;
  const std::int32_t units = model.state.look.sequence.reach();
  return (units >> kGlyphUnitBits) + (units == 0 ? 0 : 1);
}

CellRect sweepOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t ticks) {
  constexpr std::int64_t kEverywhere = INT32_MAX;
  if (model.reach > PublishedModel::kWide) return {-kEverywhere, -kEverywhere, kEverywhere, kEverywhere};
  const Motion& motion = model.state.motion;
  const bool straight = motion.acceleration == df::FixedVector{};
  const df::FixedVector velocity = straight ? motion.velocity : rebase(motion, tick).velocity;
  const df::FixedVector at = positionAt(motion, tick);
  const std::int64_t x = df::cellOf(at.x);
  const std::int64_t y = df::cellOf(at.y);
  const std::int64_t dx = cellsCovered(velocity.x, motion.acceleration.x, ticks);
  const std::int64_t dy = cellsCovered(velocity.y, motion.acceleration.y, ticks);
  return CellRect{x - (straight && velocity.x > 0 ? 0 : dx), y - (straight && velocity.y > 0 ? 0 : dy),
                  x + 1 + (straight && velocity.x < 0 ? 0 : dx),
                  y + 1 + (straight && velocity.y < 0 ? 0 : dy)}
      .grownBy(model.reach);
}

DrawForecast forecastOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t soon,
                        std::uint32_t later) {
  DrawForecast forecast;
  forecast.generation = model.generation;
  forecast.later = CompactRect(sweepOf(model, tick, later));
  if (model.reach > PublishedModel::kWide) {
    forecast.soon = forecast.later;
    return forecast;
  }
  const Motion& motion = model.state.motion;
  const df::FixedVector now = positionAt(motion, tick);
  const df::FixedVector end = isMoving(motion) ? positionAt(motion, tick + soon) : now;
  const std::int64_t left = std::min(df::cellOf(now.x), df::cellOf(end.x));
  const std::int64_t top = std::min(df::cellOf(now.y), df::cellOf(end.y));
  const std::int64_t right = std::max(df::cellOf(now.x), df::cellOf(end.x));
  const std::int64_t bottom = std::max(df::cellOf(now.y), df::cellOf(end.y));
  forecast.soon = CompactRect(CellRect{left, top, right + 1, bottom + 1}.grownBy(model.reach));
  return forecast;
}

}  // namespace naiad
