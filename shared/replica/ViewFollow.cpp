#include "shared/replica/ViewFollow.h"

#include <algorithm>

namespace naiad {

namespace {

// Adds with saturation, because boundary and target may come from a hostile server.
df::Fixed add(df::Fixed a, df::Fixed b) {
  df::Fixed sum = 0;
  if (!__builtin_add_overflow(a, b, &sum)) return sum;
  return b > 0 ? INT64_MAX : INT64_MIN;
}

df::Fixed clampAxis(df::Fixed corner, df::Fixed view, df::Fixed low, df::Fixed extent) {
  if (extent <= view) return low;
  return std::clamp(corner, low, add(low, extent - view));
}

df::Fixed followAxis(df::Fixed corner, df::Fixed view, df::Fixed target) {
  const df::Fixed slack = view / 3;
  const df::Fixed low = add(corner, slack);
  const df::Fixed high = add(corner, view - slack);
  if (target < low) return add(target, -slack);
  if (target > high) return add(target, -(view - slack));
  return corner;
}

}  // namespace

df::FixedVector clampView(const ViewFrame& f, df::FixedVector corner) {
  return {clampAxis(corner.x, f.size.x, f.boundary.corner.x, f.boundary.size.x),
          clampAxis(corner.y, f.size.y, f.boundary.corner.y, f.boundary.size.y)};
}

df::FixedVector followView(const ViewFrame& f, df::FixedVector target) {
  return clampView(f,
                   {followAxis(f.corner.x, f.size.x, target.x), followAxis(f.corner.y, f.size.y, target.y)});
}

df::FixedVector viewCornerAt(const ViewFrame& frame, std::uint32_t known, const Motion* motion,
                             std::uint32_t tick) {
  if (motion == nullptr || static_cast<std::int32_t>(tick - known) <= 0) return frame.corner;
  // A straight path needs only the first and the last step, with the result of following each step.
  const std::uint32_t from = static_cast<std::int32_t>(motion->tick - known) > 0 ? motion->tick : known + 1;
  ViewFrame moved = frame;
  moved.corner = followView(moved, positionAt(*motion, from));
  return static_cast<std::int32_t>(tick - from) > 0 ? followView(moved, positionAt(*motion, tick))
                                                    : moved.corner;
}

}  // namespace naiad
