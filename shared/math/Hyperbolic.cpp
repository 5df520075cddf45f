#include <bit>
#include <cmath>
#include <cstdint>

#include "shared/math/Elementary.h"
#include "shared/math/ExponentialCore.h"

namespace df::math {

namespace {

// Returns sinh(x) − x for |x| < 0.4.
double sineBeyondLinear(double x) {
  const double z = x * x;
  return x * z *
         (1.0 / 6 +
          z * (1.0 / 120 + z * (1.0 / 5040 + z * (1.0 / 362880 +
                                                  z * (1.0 / 39916800 + z * (1.0 / 6227020800 +
                                                                             z * (1.0 / 1307674368000)))))));
}

// Returns cosh(x) for |x| < 0.4.
DoubleDouble cosineNearOne(double x) {
  const DoubleDouble square = twoProduct(x, x);
  const double z = square.hi;
  const double series =
      1.0 / 24 + z * (1.0 / 720 + z * (1.0 / 40320 + z * (1.0 / 3628800 +
                                                          z * (1.0 / 479001600 + z * (1.0 / 87178291200)))));
  const DoubleDouble head = fastTwoSum(1, 0.5 * z);
  return fastTwoSum(head.hi, head.lo + (0.5 * square.lo + z * z * series));
}

// e^x and e^-x divided by 2^exponent, for 0.4 <= x < 711.
struct Both {
  DoubleDouble up;
  DoubleDouble down;
  int exponent;
};

Both both(double x) {
  const ScaledExponential e = scaledExponential(x);
  const DoubleDouble up = {e.hi, e.lo};
  const DoubleDouble inverse = DoubleDouble{1, 0} / up;
  const double scale = e.exponent > 400 ? 0 : scaledBy(1, -2 * e.exponent);
  return {up, {inverse.hi * scale, inverse.lo * scale}, e.exponent};
}

constexpr double kSmall = 0.4;
constexpr double kTooLarge = 711;

}  // namespace

double sinh(double x) {
  const double size = std::fabs(x);
  if (size < kSmall) return size < 0x1p-27 ? x : x + sineBeyondLinear(x);
  if (!(size < kTooLarge)) return x * 0x1p1023;
  const Both e = both(size);
  const DoubleDouble difference = e.up - e.down;
  return std::copysign(scaledBy(difference.hi, e.exponent - 1), x);
}

double cosh(double x) {
  const double size = std::fabs(x);
  if (size < kSmall) {
    const DoubleDouble sum = cosineNearOne(size);
    return sum.hi + sum.lo;
  }
  if (!(size < kTooLarge)) return size * 0x1p1023;
  const Both e = both(size);
  const DoubleDouble sum = e.up + e.down;
  return scaledBy(sum.hi, e.exponent - 1);
}

double tanh(double x) {
  const double size = std::fabs(x);
  if (size < kSmall) {
    if (size < 0x1p-27) return x;
    const DoubleDouble ratio = fastTwoSum(x, sineBeyondLinear(x)) / cosineNearOne(x);
    return ratio.hi + ratio.lo;
  }
  if (!(size < 22)) return size >= 22 ? std::copysign(1.0, x) : x;
  const Both e = both(size);
  const DoubleDouble ratio = (e.up - e.down) / (e.up + e.down);
  return std::copysign(ratio.hi, x);
}

}  // namespace df::math
