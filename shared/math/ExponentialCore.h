// e^x with a few bits more than a double, from which exp, expm1 and the hyperbolic functions are rounded.
#pragma once

#include "shared/math/DoubleDouble.h"

namespace df::math {

/// The value (hi + lo) · 2^exponent, hi in about [1, 2).
struct ScaledExponential {
  double hi;
  double lo;
  int exponent;
};

/// Returns e^x for |x| <= 800, with a relative error below 2^-60.
ScaledExponential scaledExponential(double x);

/// Returns value · 2^exponent, rounded only if the result is subnormal, and then once; ±∞ on overflow.
/// |exponent| <= 2000.
double scaledBy(double value, int exponent);

}  // namespace df::math
