// Elementary functions for game state: equal bits on every processor, compiler and optimisation level.
//
// The C library's functions differ: glibc has different code for different processors, and compilers fold
// constant arguments with another library. These functions use only + − × ÷ √ of doubles (exactly defined by
// IEEE 754) and integers. Every result is within one unit in the last place of the true value, over the whole
// range of double (measured by tests/shared/math/ElementaryTest.cpp). Rounding mode: to nearest. No function
// sets errno; the floating-point flags are unspecified. Thread-safe.
//
// A NaN argument gives a NaN; each function documents other special values. Tiny results may be subnormal.
#pragma once

namespace df::math {

inline constexpr double kPi = 0x1.921fb54442d18p+1;

/// e^x. exp(−∞) = 0, exp(+∞) = +∞; above 709.78 it is +∞, below −745.14 it is 0.
double exp(double x);
/// e^x − 1 without cancellation near 0. expm1(±0) = ±0, expm1(−∞) = −1; above 709.78 it is +∞.
double expm1(double x);
/// Natural logarithm. log(±0) = −∞, log(x < 0) = NaN, log(+∞) = +∞.
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

/// Hyperbolic tangent. tanh(±0) = ±0, tanh(±∞) = ±1.
double tanh(double x);
/// Hyperbolic sine. sinh(±0) = ±0; beyond ±710.48 it is ±∞.
double sinh(double x);
/// Hyperbolic cosine. cosh(±0) = 1; beyond ±710.48 it is +∞.
double cosh(double x);

/// The angle of the point (x, y) in [−π, π]. Zeros and infinities as in C99's annex F: atan2(±0, x > 0) = ±0,
/// atan2(±0, x < 0 or −0) = ±π, atan2(±∞, +∞) = ±π/4, and so on.
double atan2(double y, double x);
/// The angle in [−π/2, π/2] whose tangent is x. atan(±0) = ±0.
double atan(double x);
/// The angle in [−π/2, π/2] whose sine is x; NaN if |x| > 1. asin(±0) = ±0.
double asin(double x);
/// The angle in [0, π] whose cosine is x; NaN if |x| > 1.
double acos(double x);

}  // namespace df::math
