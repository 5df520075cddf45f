// Conversions from seconds: the engine counts in ticks, 30 per second (a GameManager frame of 33 ms).
//
//   ball.setVelocity(df::perSecond(df::Vector(15, 0)));             // cells per second
//   PM.setGravity(df::perSecondSquared(df::Vector(0, 18)));         // cells per second per second
#pragma once

#include "Vector.h"

namespace df {

/// Ticks per second of every game.
inline constexpr double TICKS_PER_SECOND = 30;

/// Converts a number per second to a number per tick.
constexpr double perSecond(double value) {
  return value / TICKS_PER_SECOND;
}
/// Converts a vector per second to a vector per tick.
constexpr Vector perSecond(Vector value) {
  return {perSecond(value.x()), perSecond(value.y())};
}
/// Converts a number per second² to a number per tick².
constexpr double perSecondSquared(double value) {
  return value / (TICKS_PER_SECOND * TICKS_PER_SECOND);
}
/// Converts a vector per second² to a vector per tick².
constexpr Vector perSecondSquared(Vector value) {
  return {perSecondSquared(value.x()), perSecondSquared(value.y())};
}

}  // namespace df
