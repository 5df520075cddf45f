// The elementary functions that state may depend on: the same bits on every processor, compiler and level.
//
// The C library's are not that: glibc chooses other code for other processors, and compilers fold calls with
// constant arguments by another library. These are made from + − × ÷ √ of doubles (each exactly defined by
// IEEE 754) and from integers. Every result is within one unit in the last place of the true value (measured:
// docs of the test, tests/shared/math/ElementaryTest.cpp), over the whole range of double. Rounding mode: to
// nearest. No function sets errno; the floating-point flags are not part of the promise. Any thread.
//
// A NaN argument gives a NaN; the rest is said at each function. "Tiny" results may be subnormal.
#pragma once

namespace df::math {

inline constexpr double kPi = 0x1.921fb54442d18p+1;

/// e^x. exp(−∞) = 0, exp(+∞) = +∞; above 709.78 it is +∞, below −745.14 it is 0.
double exp(double x);
/// e^x − 1 without cancellation near 0. expm1(±0) = ±0, expm1(−∞) = −1; above 709.78 it is +∞.
double expm1(double x);
/// The natural logarithm. log(±0) = −∞, log(x < 0) = NaN, log(+∞) = +∞.
double log(double x);
/// log(1 + x) without cancellation near 0. log1p(±0) = ±0, log1p(−1) = −∞, log1p(x < −1) = NaN.
double log1p(double x);

struct SineCosine {
  double sine;
  double cosine;
};
/// Sine and cosine of x radians, reduced exactly however large x is. NaN for ±∞; sin(±0) = ±0.
SineCosine sincos(double x);
double sin(double x);
double cos(double x);

/// tanh(±0) = ±0, tanh(±∞) = ±1.
double tanh(double x);
/// sinh(±0) = ±0; beyond ±710.48 it is ±∞.
double sinh(double x);
/// Beyond ±710.48 it is +∞.
double cosh(double x);

/// The angle of the point (x, y) in [−π, π]. Zeros and infinities as in C99's annex F: atan2(±0, x > 0) = ±0,
/// atan2(±0, x < 0 or −0) = ±π, atan2(±∞, +∞) = ±π/4 …
double atan2(double y, double x);
/// The angle in [−π/2, π/2] whose tangent is x. atan(±0) = ±0.
double atan(double x);
/// The angle in [−π/2, π/2] whose sine is x; NaN if |x| > 1. asin(±0) = ±0.
double asin(double x);
/// The angle in [0, π] whose cosine is x; NaN if |x| > 1.
double acos(double x);

}  // namespace df::math
