// e^x with a few bits more than a double has: what exp, expm1 and the hyperbolic functions are rounded from.
#pragma once

#include "shared/math/DoubleDouble.h"

namespace df::math {

/// (hi + lo) · 2^exponent, hi in about [1, 2).
struct ScaledExponential {
  double hi;
  double lo;
  int exponent;
};

/// e^x for |x| <= 800, with a relative error below 2^-60.
ScaledExponential scaledExponential(double x);

/// value · 2^exponent, rounded once (to a subnormal) or overflowing as it must; |exponent| <= 2000.
double scaledBy(double value, int exponent);

}  // namespace df::math
