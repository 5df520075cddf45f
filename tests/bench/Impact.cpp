#include "Impact.h"

#include <algorithm>
#include <cstdlib>

namespace bench {
namespace {

__extension__ using Wide = __int128;

// Returns the steps of one axis on which the boxes touch. Mirrors the axis if necessary, so that the
// coordinate increases.
std::optional<Steps> stepsOf(df::Fixed low, df::Fixed size, df::Fixed way, df::Fixed other,
                             df::Fixed other_size) {
  if (way < 0) return stepsOf(-low - size, size, -way, -other - other_size, other_size);
  const df::Fixed to_meet = other - (low + size);
  const df::Fixed to_part = other + other_size - low;
  if (to_meet > way || to_part < 0) return std::nullopt;
  return Steps{std::max<df::Fixed>(to_meet, 0), to_part, way};
}

df::Fixed goneOn(df::Fixed way, Fraction time, bool before) {
  const Wide exact = static_cast<Wide>(std::abs(way)) * time.over;
  if (exact == 0) return 0;
  const auto steps = static_cast<df::Fixed>((before ? exact - 1 : exact) / time.under);
  return way < 0 ? -steps : steps;
}

}  // namespace

bool areTouching(const df::FixedBox& a, const df::FixedBox& b) {
  const auto gap = [](df::Fixed a_low, df::Fixed a_size, df::Fixed b_low, df::Fixed b_size) {
    return std::max(b_low - (a_low + a_size), a_low - (b_low + b_size));
  };
  return gap(a.corner.x, a.size.x, b.corner.x, b.size.x) <= 0 &&
         gap(a.corner.y, a.size.y, b.corner.y, b.size.y) <= 0;
}

std::optional<Steps> Path::stepsX(const df::FixedBox& obstacle) const {
  return stepsOf(m_box.corner.x, m_box.size.x, m_way.x, obstacle.corner.x, obstacle.size.x);
}

std::optional<Steps> Path::stepsY(const df::FixedBox& obstacle) const {
  return stepsOf(m_box.corner.y, m_box.size.y, m_way.y, obstacle.corner.y, obstacle.size.y);
}

std::optional<Fraction> Path::firstTouch(const df::FixedBox& obstacle) const {
  const std::optional<Steps> x = stepsX(obstacle);
  if (!x) return std::nullopt;
  const std::optional<Steps> y = stepsY(obstacle);
  if (!y) return std::nullopt;
  const Fraction time = std::max(x->begin(), y->begin());
  if (time < x->end() && time < y->end()) return time;
  return std::nullopt;
}

df::FixedVector Path::goneAt(Fraction time) const {
  return {goneOn(m_way.x, time, false), goneOn(m_way.y, time, false)};
}

df::FixedVector Path::goneBefore(Fraction time) const {
  return {goneOn(m_way.x, time, true), goneOn(m_way.y, time, true)};
}

}  // namespace bench
