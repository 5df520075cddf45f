#include "host/snapshot/ClientViewport.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/replica/ViewCrop.h"
#include "shared/replica/ViewFollow.h"

namespace naiad {

namespace {

/// Cells around the view whose objects a predicting client needs, because its player may collide with them.
constexpr std::int32_t kCollisionMargin = 2;
/// Ticks by which the player may be behind or ahead in the client's picture, which is past or predicted.
constexpr double kOffTicks = 12;
/// Minimum of Axis::spare, in cells: a key may move the player in steps, so the client's picture may differ
/// from the world by this much at once.
constexpr std::int64_t kMinSpare = 6;
/// Interval in ticks at which an Axis::spare that is larger than needed shrinks by a cell.
constexpr std::uint32_t kShrinkInterval = 8;

int clampedSize(std::uint32_t cells, int min_cells, int max_cells) {
  return cells == 0
             ? max_cells
             : std::clamp(static_cast<int>(std::min<std::uint32_t>(cells, 1000)), min_cells, max_cells);
}

}  // namespace

void ClientViewport::setTerminal(std::uint32_t columns, std::uint32_t rows) {
  m_x.cells = clampedSize(columns, kMinColumns, kMaxViewWidth);
  m_y.cells = clampedSize(rows, kMinRows, kMaxViewHeight);
}

// The spare grows at once but shrinks slowly, because the client learns late that a player has stopped.
void ClientViewport::Axis::updateSpare(double cells_per_tick, std::uint32_t tick) {
  const double max_cells = std::min(std::abs(cells_per_tick) * kOffTicks, double{kMaxViewWidth});
  const std::int64_t wanted = kMinSpare + static_cast<std::int64_t>(std::ceil(max_cells));
  spare = std::max(wanted, spare - (tick % kShrinkInterval == 0 ? 1 : 0));
}

void ClientViewport::Axis::cover(std::int64_t corner, int extent, std::int64_t focus, std::int64_t& low,
                                 std::int64_t& high) const {
  std::int64_t first = corner;
  std::int64_t end = corner + extent;
  if (cells < extent) {
    const auto in_view = static_cast<int>(std::clamp<std::int64_t>(focus - corner, 0, extent - 1));
    const std::int64_t start = corner + cropStart(in_view, cells, extent);
    first = std::max(first, start - spare);
    end = std::min(end, start + cells + spare);
  }
  low = std::min(low, first);
  high = std::max(high, end);
}

CellRect ClientViewport::update(const Publisher& publisher, const df::PlayerFacts& player,
                                std::uint32_t look_ahead) {
  const WorldRecord& world = publisher.world();
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  CellRect window{kFar, kFar, -kFar, -kFar};
  const auto cover = [&](std::int64_t left, std::int64_t top, std::int64_t x, std::int64_t y) {
    m_x.cover(left, world.view_width, x, window.left, window.right);
    m_y.cover(top, world.view_height, y, window.top, window.bottom);
  };

  const std::int64_t left = df::cellOf(player.view_corner.x);
  const std::int64_t top = df::cellOf(player.view_corner.y);
  const Publisher::Model* followed =
      player.followed.generation != 0 ? publisher.find(player.followed.slot) : nullptr;
  if (followed == nullptr) {
    cover(left, top, left + world.view_width / 2, top + world.view_height / 2);
  } else {
    const Motion& motion = followed->state.motion;
    m_x.updateSpare(df::toCells(motion.velocity.x), publisher.tick());
    m_y.updateSpare(df::toCells(motion.velocity.y), publisher.tick());
    const df::FixedVector now = positionAt(motion, publisher.tick());
    const df::FixedVector next = positionAt(motion, publisher.tick() + look_ahead);
    const ViewFrame frame{player.view_corner,
                          {df::fromCells(world.view_width), df::fromCells(world.view_height)},
                          world.boundary};
    const df::FixedVector later = followView(frame, next);
    const std::int64_t dx =
        std::clamp<std::int64_t>(df::cellOf(later.x) - left, -world.view_width, world.view_width);
    const std::int64_t dy =
        std::clamp<std::int64_t>(df::cellOf(later.y) - top, -world.view_height, world.view_height);
    cover(left, top, df::cellOf(now.x), df::cellOf(now.y));
    cover(left + dx, top + dy, df::cellOf(next.x), df::cellOf(next.y));
  }
  return player.steering.p_table != nullptr ? window.grownBy(kCollisionMargin) : window;
}

}  // namespace naiad
