#include "Glyphs.h"

#include <algorithm>

namespace bench {
namespace {

constexpr double kSetPart = 0.55;

df::Fixed cellOfCorner(df::Fixed corner) {
  return (corner >> df::kFixedBits) + 1;
}

// Adds to `times` when the moving box's corner enters another cell while the boxes touch on this axis, and
// when they begin to touch.
void addChanges(const Steps& steps, df::Fixed low, bool back, std::vector<Fraction>& times) {
  times.push_back(steps.begin());
  const df::Fixed last = std::min(steps.last, steps.way);
  const auto after = [low, back](df::Fixed step) { return back ? low - step : low + step; };
  for (df::Fixed step = steps.first; step < last;) {
    const df::Fixed in_cell = after(step) & (df::kFixedOne - 1);
    step += back ? in_cell + 1 : df::kFixedOne - in_cell;
    if (step <= last) times.push_back({step, steps.way});
  }
}

}  // namespace

Glyphs Glyphs::random(naiad::SplitMix64& random) {
  Glyphs glyphs;
  const std::uint64_t width = 3 + random.below(10);
  const std::uint64_t height = 2 + random.below(3);
  glyphs.m_rows.assign(height, std::string(width, ' '));
  for (std::string& row : glyphs.m_rows) {
    for (char& character : row) {
      if (random.unit() < kSetPart) character = '#';
    }
  }
  return glyphs;
}

bool Glyphs::isSet(std::int64_t x, std::int64_t y) const {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return false;
  return m_rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] != ' ';
}

bool shareCell(const Glyphs& a, const df::FixedBox& a_box, const Glyphs& b, const df::FixedBox& b_box) {
  const df::Fixed right = cellOfCorner(a_box.corner.x) - cellOfCorner(b_box.corner.x);
  const df::Fixed down = cellOfCorner(a_box.corner.y) - cellOfCorner(b_box.corner.y);
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      if (a.isSet(x, y) && b.isSet(x + right, y + down)) return true;
    }
  }
  return false;
}

std::optional<Fraction> firstShare(const Path& path, const Glyphs& own, const df::FixedBox& obstacle,
                                   const Glyphs& others) {
  const std::optional<Steps> x = path.stepsX(obstacle);
  const std::optional<Steps> y = path.stepsY(obstacle);
  if (!x || !y) return std::nullopt;
  std::vector<Fraction> times;
  addChanges(*x, path.start().corner.x, path.way().x < 0, times);
  addChanges(*y, path.start().corner.y, path.way().y < 0, times);
  std::sort(times.begin(), times.end());
  for (const Fraction time : times) {
    const df::FixedBox box = df::translate(path.start(), path.goneAt(time));
    if (areTouching(box, obstacle) && shareCell(own, box, others, obstacle)) return time;
  }
  return std::nullopt;
}

}  // namespace bench
