#include "Vector.h"

#include <cmath>

namespace df {

// sqrt is correctly rounded by IEEE 754, hypot is not: only the former is the same on every machine.
static double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

float Vector::getMagnitude() const {
  return static_cast<float>(length(m_x, m_y));
}

void Vector::scale(double s) {
  m_x *= s;
  m_y *= s;
}

void Vector::normalize() {
  const double magnitude = length(m_x, m_y);
  if (magnitude > 0) {
    m_x /= magnitude;
    m_y /= magnitude;
  }
}

Vector& Vector::operator+=(const Vector& other) {
  m_x += other.m_x;
  m_y += other.m_y;
  return *this;
}

Vector& Vector::operator-=(const Vector& other) {
  m_x -= other.m_x;
  m_y -= other.m_y;
  return *this;
}

std::string Vector::toString() const {
  return "(" + std::to_string(m_x) + "," + std::to_string(m_y) + ")";
}

}  // namespace df
