#include <array>
#include <bit>
#include <cstdint>

#include "shared/math/Elementary.h"
#include "shared/math/ExponentialCore.h"

namespace df::math {

namespace {

constexpr int kSteps = 64;  // table entries per doubling

// ln 2 / 64. The first part has 36 bits, so that its product with a number of steps (17 bits) is exact.
constexpr double kStep1 = 0x1.62e42fefap-7;
constexpr double kStep2 = 0x1.cf79abc9e3b3ap-46;
constexpr double kStepsPerUnit = 0x1.71547652b82fep+6;

// 2^(i/64).
constexpr std::array<DoubleDouble, kSteps> kPowers = [] {
  constexpr DoubleDouble kLn2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
  std::array<DoubleDouble, kSteps> powers{};
  for (int i = 0; i < kSteps; ++i) {
    const DoubleDouble x = kLn2 * (static_cast<double>(i) / kSteps);
    DoubleDouble sum = {1, 0};
    for (int n = 28; n > 0; --n) sum = x * sum / DoubleDouble{static_cast<double>(n), 0} + 1.0;
    powers[i] = sum;
  }
  return powers;
}();

double powerOfTwo(int exponent) {  // −1022 to 1023
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// Returns e^x − 1 for |x| < 0.4, as the sum of an exact head and a small tail.
DoubleDouble nearOne(double x) {
  const double series =
      1.0 / 6 +
      x * (1.0 / 24 +
           x * (1.0 / 120 +
                x * (1.0 / 720 +
                     x * (1.0 / 5040 +
                          x * (1.0 / 40320 +
                               x * (1.0 / 362880 +
                                    x * (1.0 / 3628800 +
                                         x * (1.0 / 39916800 +
                                              x * (1.0 / 479001600 +
                                                   x * (1.0 / 6227020800 + x * (1.0 / 87178291200)))))))))));
  const DoubleDouble square = twoProduct(x, x);
  const DoubleDouble head = fastTwoSum(x, 0.5 * square.hi);
  return {head.hi, head.lo + 0.5 * square.lo + square.hi * x * series};
}

}  // namespace

ScaledExponential scaledExponential(double x) {
  const double steps = rounded(x * kStepsPerUnit);
  const int whole = static_cast<int>(steps);
  const DoubleDouble r = twoSum(x - steps * kStep1, -(steps * kStep2));
  const double series =
      r.lo +
      r.hi * r.hi * (0.5 + r.hi * (1.0 / 6 + r.hi * (1.0 / 24 + r.hi * (1.0 / 120 + r.hi * (1.0 / 720)))));
  const DoubleDouble power = kPowers[whole & (kSteps - 1)];
  const DoubleDouble sum = fastTwoSum(power.hi, power.hi * r.hi);
  const DoubleDouble all = fastTwoSum(sum.hi, sum.lo + (power.lo + (power.hi * series + power.lo * r.hi)));
  return {all.hi, all.lo, whole >> 6};
}

double scaledBy(double value, int exponent) {
  if (exponent > 1023) return value * 0x1p1023 * powerOfTwo(exponent - 1023 > 1023 ? 1023 : exponent - 1023);
  if (exponent >= -1022) return value * powerOfTwo(exponent);
  return value * powerOfTwo(exponent + 1000 < -1022 ? -1022 : exponent + 1000) * 0x1p-1000;
}

double exp(double x) {
  if (!(x > -746)) return x < 0 ? 0.0 : x;  // x is a NaN in the second case
  if (x > 710) return x * 0x1p1023;
  const ScaledExponential e = scaledExponential(x);
  return scaledBy(e.hi, e.exponent);
}

double expm1(double x) {
  if (x > -0.4 && x < 0.4) {
    if (x > -0x1p-54 && x < 0x1p-54) return x;
    const DoubleDouble sum = nearOne(x);
    return sum.hi + sum.lo;
  }
  if (!(x > -40)) return x < 0 ? -1.0 : x;
  if (x > 710) return x * 0x1p1023;
  const ScaledExponential e = scaledExponential(x);
  if (e.exponent > 60) return scaledBy(e.hi, e.exponent);
  const double unit = powerOfTwo(e.exponent);
  const DoubleDouble sum = twoSum(e.hi * unit, -1);
  return sum.hi + (sum.lo + e.lo * unit);
}

}  // namespace df::math
