// Conversions from seconds: the engine counts in ticks, 30 per second (GameManager's frame of 33 ms).
//
//   ball.setVelocity(df::perSecond(df::Vector(15, 0)));             // cells per second
//   PM.setGravity(df::perSecondSquared(df::Vector(0, 18)));         // cells per second per second
#pragma once

#include "Vector.h"

namespace df {

inline constexpr double TICKS_PER_SECOND = 30;

/// Converts from per second to per tick.
constexpr double perSecond(double value) {
  return value / TICKS_PER_SECOND;
}
/// Converts from per second to per tick.
constexpr Vector perSecond(Vector value) {
  return {perSecond(value.x()), perSecond(value.y())};
}
/// Converts from per second² to per tick².
constexpr double perSecondSquared(double value) {
  return value / (TICKS_PER_SECOND * TICKS_PER_SECOND);
}
/// Converts from per second² to per tick².
constexpr Vector perSecondSquared(Vector value) {
  return {perSecondSquared(value.x()), perSecondSquared(value.y())};
}

}  // namespace df
