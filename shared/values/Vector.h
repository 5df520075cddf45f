// A 2d vector in cells: positions, directions, velocities (Dragonfly book, Listing 4.26 and following).
//
// The components are doubles; getX() and getY() return float, as the book prints them, and x() and y() return
// the doubles. y grows downward. The World stores positions in fixed point (Fixed.h), so it rounds the
// components to 2^-32 cell.
#pragma once

#include <iosfwd>
#include <string>

#include "Fixed.h"

namespace df {

class Vector {
 public:
  /// Makes the vector (0, 0).
  constexpr Vector() = default;
  constexpr Vector(double x, double y) : m_x(x), m_y(y) {}
  /// Returns the exact value of a fixed-point vector (rounded beyond 2^21 cells, see Fixed.h).
  static constexpr Vector fromFixed(FixedVector v) { return {toCells(v.x), toCells(v.y)}; }

  /// Sets the components, in cells or cells per tick.
  void setX(double x) { m_x = x; }
  void setY(double y) { m_y = y; }
  void setXY(double x, double y) {
    m_x = x;
    m_y = y;
  }
  /// Returns the component as a float, as in the book.
  float getX() const { return static_cast<float>(m_x); }
  float getY() const { return static_cast<float>(m_y); }
  /// Returns the component in double precision: a float is too short beyond about 10,000 cells.
  constexpr double x() const { return m_x; }
  constexpr double y() const { return m_y; }

  /// Returns the length, in the unit of the components; 0 for the zero vector.
  float getMagnitude() const;
  /// Multiplies both components by `s`.
  void scale(double s);
  /// Sets the length to 1 and keeps the direction. The zero vector is unchanged.
  void normalize();

  /// Add and subtract component by component.
  Vector& operator+=(const Vector& other);
  Vector& operator-=(const Vector& other);
  friend Vector operator+(Vector a, const Vector& b) { return a += b; }
  friend Vector operator-(Vector a, const Vector& b) { return a -= b; }
  friend constexpr bool operator==(const Vector& a, const Vector& b) {
    return a.m_x == b.m_x && a.m_y == b.m_y;
  }
  friend constexpr bool operator!=(const Vector& a, const Vector& b) { return !(a == b); }

  /// True for (0,0).
  bool operator!() const { return m_x == 0 && m_y == 0; }

  /// Write and read both components. Return 0, or -1 if the stream is null or failed.
  int serialize(std::stringstream* p_ss) const;
  int deserialize(std::stringstream* p_ss);

  /// Returns "(x,y)", for log lines.
  std::string toString() const;

 private:
  double m_x = 0;
  double m_y = 0;
};

#if __cplusplus >= 201703L
/// Converts both components to fixed point; nullopt if either is not finite or beyond `limit` cells.
inline std::optional<FixedVector> toFixed(const Vector& v, double limit = kMaxCells) {
  const auto x = toFixed(v.x(), limit);
  const auto y = toFixed(v.y(), limit);
  if (!x || !y) return std::nullopt;
  return FixedVector{*x, *y};
}
#endif

}  // namespace df
