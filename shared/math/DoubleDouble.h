// Sums of two doubles that do not overlap: about 106 bits, from + − × ÷ √ in double precision alone.
//
// Used by the elementary functions, for which one double is too short. The exact sum is Knuth's, the exact
// product Dekker's with Veltkamp's splitting (T. J. Dekker, "A floating-point technique for extending the
// available precision", 1971). Without fused multiply-add, every machine gets the same bits. Everything
// except squareRoot() is constexpr, so that the compiler can compute tables.
#pragma once

#include <cmath>

namespace df::math {

/// Rounds `x` to the nearest whole number, ties to even, for |x| < 2^51: the sum with kShift has no fraction.
constexpr double rounded(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

/// The unevaluated sum hi + lo, |lo| <= half a unit in the last place of hi.
struct DoubleDouble {
  double hi = 0;
  double lo = 0;
};

/// Returns a + b exactly, for any order of magnitudes, unless a + b overflows.
constexpr DoubleDouble twoSum(double a, double b) {
  const double sum = a + b;
  const double from_b = sum - a;
  return {sum, (a - (sum - from_b)) + (b - from_b)};
}

/// Returns a + b exactly, for |a| >= |b| or a = 0.
constexpr DoubleDouble fastTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Returns the upper 26 bits of `a`; the rest also fits 26 bits. |a| < 2^996.
constexpr double upperHalf(double a) {
  const double scaled = 134217729.0 * a;  // 2^27 + 1
  return scaled - (scaled - a);
}

/// Returns a · b exactly, if the product is finite and above 2^-968, and both factors are below 2^996 (all in
/// magnitude).
constexpr DoubleDouble twoProduct(double a, double b) {
  const double product = a * b;
  const double a1 = upperHalf(a), b1 = upperHalf(b);
  const double a2 = a - a1, b2 = b - b1;
  return {product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

constexpr DoubleDouble operator-(DoubleDouble a) {
  return {-a.hi, -a.lo};
}

constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble upper = twoSum(a.hi, b.hi);
  const DoubleDouble lower = twoSum(a.lo, b.lo);
  const DoubleDouble first = fastTwoSum(upper.hi, upper.lo + lower.hi);
  return fastTwoSum(first.hi, first.lo + lower.lo);
}

constexpr DoubleDouble operator+(DoubleDouble a, double b) {
  const DoubleDouble upper = twoSum(a.hi, b);
  return fastTwoSum(upper.hi, upper.lo + a.lo);
}

constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
  return a + -b;
}

constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble upper = twoProduct(a.hi, b.hi);
  return fastTwoSum(upper.hi, upper.lo + (a.hi * b.lo + a.lo * b.hi));
}

constexpr DoubleDouble operator*(DoubleDouble a, double b) {
  const DoubleDouble upper = twoProduct(a.hi, b);
  return fastTwoSum(upper.hi, upper.lo + a.lo * b);
}

constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double quotient = a.hi / b.hi;
  const DoubleDouble rest = a - b * quotient;
  return fastTwoSum(quotient, (rest.hi + rest.lo) / b.hi);
}

/// Returns the square root of a >= 0.
inline DoubleDouble squareRoot(DoubleDouble a) {
  const double root = std::sqrt(a.hi);
  if (root == 0) return {};
  const DoubleDouble rest = a - twoProduct(root, root);
  return fastTwoSum(root, (rest.hi + rest.lo) / (2 * root));
}

}  // namespace df::math
