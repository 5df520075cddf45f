#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "shared/math/DoubleDouble.h"
#include "shared/math/Elementary.h"

namespace df::math {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// ln 2. The first part has 42 bits, so that its product with an exponent is exact.
constexpr double kLn2Upper = 0x1.62e42fefa38p-1;
constexpr double kLn2Lower = 0x1.ef35793c7673p-45;

// log(i / 64) for the multiples of 1/64 nearest to a mantissa in [√½, √2].
constexpr int kFirst = 45;
constexpr int kLast = 91;
constexpr std::array<DoubleDouble, kLast - kFirst + 1> kLogarithms = [] {
  std::array<DoubleDouble, kLast - kFirst + 1> logarithms{};
  for (int i = kFirst; i <= kLast; ++i) {  // 2 artanh((i − 64) / (i + 64))
    const DoubleDouble z = DoubleDouble{i - 64.0, 0} / DoubleDouble{i + 64.0, 0};
    const DoubleDouble square = z * z;
    DoubleDouble sum{};
    for (int n = 45; n > 0; n -= 2) sum = sum * square + DoubleDouble{1, 0} / DoubleDouble{1.0 * n, 0};
    logarithms[i - kFirst] = z * sum * 2.0;
  }
  return logarithms;
}();

// Returns log(1 + r) − r for |r| < 1/80.
double beyondLinear(double r) {
  const double series =
      1.0 / 3 +
      r * (-1.0 / 4 +
           r * (1.0 / 5 + r * (-1.0 / 6 + r * (1.0 / 7 + r * (-1.0 / 8 + r * (1.0 / 9 + r * (-1.0 / 10)))))));
  return r * r * (-0.5 + r * series);
}

// Returns log((hi + lo)·2^exponent) for a normal hi > 0 and |lo| below half a unit in the last place of hi.
double logarithm(double hi, double lo, int exponent) {
  const auto bits = std::bit_cast<std::uint64_t>(hi);
  int shift = static_cast<int>(bits >> 52) - 1023;
  double mantissa = std::bit_cast<double>((bits & 0xfffffffffffffULL) | 0x3ff0000000000000ULL);
  if (mantissa > 1.4140625) {
    mantissa *= 0.5;
    ++shift;
  }
  double tail = 0;
  if (lo != 0) {                 // then the shift is at least −53
    const int half = shift / 2;  // 2^-shift alone may be out of range
    tail = lo * std::bit_cast<double>(static_cast<std::uint64_t>(1023 - half) << 52) *
           std::bit_cast<double>(static_cast<std::uint64_t>(1023 - (shift - half)) << 52);
  }
  const double steps = rounded(mantissa * 64), c = steps / 64;
  const int index = static_cast<int>(steps);
  const double difference = mantissa - c;  // exact
  double r = difference;
  if (index != 64) {
    r = difference / c;
    const DoubleDouble product = twoProduct(r, c);
    tail = (((difference - product.hi) - product.lo) + tail) / c;
  }
  const double e = shift + exponent;
  const DoubleDouble known = kLogarithms[index - kFirst];
  const DoubleDouble whole = twoSum(e * kLn2Upper, known.hi);
  const DoubleDouble sum = twoSum(whole.hi, r);
  return sum.hi + (sum.lo + (whole.lo + known.lo + e * kLn2Lower + (tail - tail * r + beyondLinear(r))));
}

}  // namespace

double log(double x) {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNaN;
  if (x == kInfinity) return x;
  if (x < 0x1p-1022) return logarithm(x * 0x1p54, 0, -54);
  return logarithm(x, 0, 0);
}

double log1p(double x) {
  if (!(x > -1)) return x == -1 ? -kInfinity : kNaN;
  if (x > -0x1p-7 && x < 0x1p-7) {
    if (x > -0x1p-54 && x < 0x1p-54) return x;
    return x + beyondLinear(x);
  }
  if (x == kInfinity) return x;
  const DoubleDouble sum = twoSum(1, x);
  return logarithm(sum.hi, sum.lo, 0);
}

}  // namespace df::math
