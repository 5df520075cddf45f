// A vector in metric cells, the unit of all physics calculations. All functions but length() are constexpr.
//
// y grows downward, as everywhere in the project; a positive angle therefore turns clockwise on the screen.
#pragma once

#include <cmath>

namespace naiad::physics {

struct Vec2 {
  double x = 0;
  double y = 0;

  constexpr Vec2& operator+=(Vec2 b) { return *this = {x + b.x, y + b.y}; }
  constexpr Vec2& operator-=(Vec2 b) { return *this = {x - b.x, y - b.y}; }
  constexpr Vec2& operator*=(double s) { return *this = {x * s, y * s}; }
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
  friend constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
  friend constexpr Vec2 operator*(Vec2 a, double s) { return {s * a.x, s * a.y}; }
  friend constexpr Vec2 operator/(Vec2 a, double s) { return {a.x / s, a.y / s}; }
  friend constexpr bool operator==(Vec2 a, Vec2 b) = default;
};

constexpr double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
/// Returns the z component of the cross product: positive if b is clockwise from a on the screen.
constexpr double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
/// Returns the velocity of the point `a` of a body that turns at `spin` rad per unit of time.
constexpr Vec2 cross(double spin, Vec2 a) {
  return {-spin * a.y, spin * a.x};
}
/// Returns `a` rotated by a right angle, from x to y.
constexpr Vec2 perpendicular(Vec2 a) {
  return {-a.y, a.x};
}
constexpr double lengthSquared(Vec2 a) {
  return dot(a, a);
}
/// Overflows for lengths above 1e154; the physics accepts only values below 1e30.
inline double length(Vec2 a) {
  return std::sqrt(lengthSquared(a));
}
/// True if both components are finite.
constexpr bool isFinite(Vec2 a) {
  return a.x - a.x == 0 && a.y - a.y == 0;
}

}  // namespace naiad::physics
