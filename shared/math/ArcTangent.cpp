#include <array>
#include <cmath>
#include <limits>

#include "shared/math/DoubleDouble.h"
#include "shared/math/Elementary.h"

namespace df::math {

namespace {

constexpr DoubleDouble kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr DoubleDouble kWholePi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

// atan(i / 16), each computed from the previous one by the addition theorem.
constexpr std::array<DoubleDouble, 17> kAngles = [] {
  std::array<DoubleDouble, 17> angles{};
  for (int i = 1; i <= 16; ++i) {
    const DoubleDouble z = DoubleDouble{16, 0} / DoubleDouble{256.0 + i * (i - 1), 0};
    const DoubleDouble square = z * z;
    DoubleDouble sum{};
    for (int n = 29; n > 0; n -= 2) {
      const DoubleDouble term = DoubleDouble{1, 0} / DoubleDouble{1.0 * n, 0};
      sum = sum * square + (n % 4 == 1 ? term : -term);
    }
    angles[i] = angles[i - 1] + z * sum;
  }
  return angles;
}();

// Returns the angle of (x, y) for 0 <= y <= x, with x within 2^±100, and y = 0 or at least 2^-70 · x.
DoubleDouble angleInOctant(DoubleDouble y, DoubleDouble x) {
  const double steps = rounded(y.hi / x.hi * 16), c = steps / 16;
  const int index = static_cast<int>(steps);
  const DoubleDouble r = (y - x * c) / (x + y * c);
  const double z = r.hi * r.hi;
  const double series =
      -1.0 / 3 + z * (1.0 / 5 + z * (-1.0 / 7 + z * (1.0 / 9 + z * (-1.0 / 11 + z * (1.0 / 13)))));
  const DoubleDouble sum = twoSum(kAngles[index].hi, r.hi);
  return {sum.hi, sum.lo + (kAngles[index].lo + (r.lo + r.hi * z * series))};
}

double sumOf(DoubleDouble a) {
  return a.hi + a.lo;
}

}  // namespace

double atan2(double y, double x) {
  if (!(x == x && y == y)) return x + y;
  const double up = std::fabs(y), along = std::fabs(x);
  const bool is_left = std::signbit(x);
  if (up == 0) return std::copysign(is_left ? kPi : 0.0, y);
  if (along == 0) return std::copysign(kPi / 2, y);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (along == kInfinity || up == kInfinity) {
    if (along != up) return std::copysign(up == kInfinity ? kPi / 2 : is_left ? kPi : 0.0, y);
    return std::copysign(is_left ? 0x1.2d97c7f3321d2p+1 : kPi / 4, y);  // 3π/4
  }
  int exponent_up = 0, exponent_along = 0;
  const double m_up = std::frexp(up, &exponent_up), m_along = std::frexp(along, &exponent_along);
  const int steepness = exponent_up - exponent_along;
  if (steepness > 60) return std::copysign(kPi / 2, y);
  if (steepness < -60) return std::copysign(is_left ? kPi : up / along, y);

  const double scaled_up = std::ldexp(m_up, steepness);
  const bool is_steep = scaled_up > m_along;
  DoubleDouble angle = is_steep ? kHalfPi - angleInOctant({m_along, 0}, {scaled_up, 0})
                                : angleInOctant({scaled_up, 0}, {m_along, 0});
  if (is_left) angle = kWholePi - angle;
  return std::copysign(sumOf(angle), y);
}

double atan(double x) {
  return atan2(x, 1);
}

// Returns √(1 − x²).
static DoubleDouble cathetus(double x) {
  return squareRoot(-twoProduct(x, x) + 1.0);
}

double asin(double x) {
  const double size = std::fabs(x);
  if (!(size <= 1)) return (x - x) / (x - x);
  if (size < 0x1p-27) return x;
  const DoubleDouble other = cathetus(size);
  const DoubleDouble angle =
      size > other.hi ? kHalfPi - angleInOctant(other, {size, 0}) : angleInOctant({size, 0}, other);
  return std::copysign(sumOf(angle), x);
}

double acos(double x) {
  const double size = std::fabs(x);
  if (!(size <= 1)) return (x - x) / (x - x);
  if (size < 0x1p-60) return kPi / 2;
  const DoubleDouble other = cathetus(size);
  const DoubleDouble angle =
      size < other.hi ? kHalfPi - angleInOctant({size, 0}, other) : angleInOctant(other, {size, 0});
  return sumOf(x < 0 ? kWholePi - angle : angle);
}

}  // namespace df::math
