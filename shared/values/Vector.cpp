#include "shared/values/Vector.h"

#include <cmath>
#include <sstream>

namespace df {

// IEEE 754 rounds sqrt correctly, but not hypot: only sqrt is equal on every machine.
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

int Vector::serialize(std::stringstream* p_ss) const {
  if (p_ss == nullptr) return -1;
  const auto precision = p_ss->precision(17);
  *p_ss << m_x << ' ' << m_y << ' ';
  p_ss->precision(precision);
  return p_ss->good() ? 0 : -1;
}

int Vector::deserialize(std::stringstream* p_ss) {
  double x = 0;
  double y = 0;
  if (p_ss == nullptr || !(*p_ss >> x >> y)) return -1;
  setXY(x, y);
  return 0;
}

std::string Vector::toString() const {
  std::string text = "(";
  text += std::to_string(m_x);
  text += ',';
  text += std::to_string(m_y);
  return text += ')';
}

}  // namespace df
