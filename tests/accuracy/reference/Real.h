// Number types, so that equations of motion need to be written only once: double, quad precision (113 bits),
// and dual numbers, which also compute derivatives.
#pragma once

#include <quadmath.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace lab {

using Quad = __float128;

inline const Quad kQuadPi = acosq(-1);

using std::abs;
using std::cos;
using std::exp;
using std::log;
using std::sin;
using std::sqrt;
using std::tanh;

inline Quad abs(Quad x) {
  return fabsq(x);
}
inline Quad cos(Quad x) {
  return cosq(x);
}
inline Quad exp(Quad x) {
  return expq(x);
}
inline Quad log(Quad x) {
  return logq(x);
}
inline Quad sin(Quad x) {
  return sinq(x);
}
inline Quad sqrt(Quad x) {
  return sqrtq(x);
}
inline Quad tanh(Quad x) {
  return tanhq(x);
}

/// A value and its N partial derivatives.
template <int N>
struct Dual {
  double value = 0;
  std::array<double, static_cast<std::size_t>(N)> slope{};

  Dual() = default;
  Dual(double its_value) : value(its_value) {}  // implicit, for constants in equations
  static Dual variable(double value, int index) {
    Dual dual(value);
    dual.slope[static_cast<std::size_t>(index)] = 1;
    return dual;
  }
  /// Returns f(*this), given the value `its_value` of f at that point and its derivative `its_slope`.
  Dual chain(double its_value, double its_slope) const {
    Dual result(its_value);
    for (std::size_t i = 0; i < slope.size(); ++i) result.slope[i] = its_slope * slope[i];
    return result;
  }

  friend Dual operator-(const Dual& a) { return a.chain(-a.value, -1); }
  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual sum(a.value + b.value);
    for (std::size_t i = 0; i < sum.slope.size(); ++i) sum.slope[i] = a.slope[i] + b.slope[i];
    return sum;
  }
  friend Dual operator-(const Dual& a, const Dual& b) { return a + -b; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual product(a.value * b.value);
    for (std::size_t i = 0; i < product.slope.size(); ++i) {
      product.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    }
    return product;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return a * b.chain(1 / b.value, -1 / (b.value * b.value));
  }
  friend Dual abs(const Dual& a) { return a.value < 0 ? -a : a; }
  friend Dual sin(const Dual& a) { return a.chain(std::sin(a.value), std::cos(a.value)); }
  friend Dual cos(const Dual& a) { return a.chain(std::cos(a.value), -std::sin(a.value)); }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return a.chain(root, 0.5 / root);
  }
};

}  // namespace lab
