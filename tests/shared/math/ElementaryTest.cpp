#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "shared/math/Elementary.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/Quad.h"

namespace df {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
using naiad::SplitMix64;

constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
constexpr double kLargest = std::numeric_limits<double>::max();

// Returns |value − truth| in units in the last place of the truth.
double ulps(double value, Quad truth) {
  if (!std::isfinite(value)) {  // truths beyond the largest number plus half a unit must give infinity
    const Quad limit = static_cast<Quad>(kLargest) + static_cast<Quad>(0x1p969);
    return std::isinf(value) && fabsq(truth) >= limit && (truth > 0) == (value > 0) ? 0 : kInfinity;
  }
  int exponent = 0;
  std::frexp(static_cast<double>(truth), &exponent);
  const double unit = std::ldexp(1, std::max(exponent - 53, -1074));
  return static_cast<double>(fabsq(static_cast<Quad>(value) - truth) / static_cast<Quad>(unit));
}

// Returns a finite double with a random bit pattern.
double anyDouble(SplitMix64& random) {
  for (;;) {
    const double x = std::bit_cast<double>(random.next());
    if (std::isfinite(x)) return x;
  }
}

double uniform(SplitMix64& random, double low, double high) {
  return low + (high - low) * random.unit();
}

struct Function {
  const char* name;
  double (*own)(double);
  Quad (*reference)(Quad);
  double low, high;  // range of ordinary arguments
};

const std::vector<Function> kFunctions = {
    {"exp", math::exp, expq, -745, 710},    {"expm1", math::expm1, expm1q, -40, 710},
    {"log", math::log, logq, 0, 4},         {"log1p", math::log1p, log1pq, -1, 4},
    {"sin", math::sin, sinq, -10, 10},      {"cos", math::cos, cosq, -10, 10},
    {"tanh", math::tanh, tanhq, -22, 22},   {"sinh", math::sinh, sinhq, -711, 711},
    {"cosh", math::cosh, coshq, -711, 711}, {"atan", math::atan, atanq, -20, 20},
    {"asin", math::asin, asinq, -1, 1},     {"acos", math::acos, acosq, -1, 1},
};

class Elementary : public testing::TestWithParam<Function> {};
INSTANTIATE_TEST_SUITE_P(All, Elementary, testing::ValuesIn(kFunctions),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Elementary, IsWithinOneUlp) {
  const Function& f = GetParam();
  SplitMix64 random(1);
  double worst = 0, worst_at = 0;
  const auto check = [&](double x) {
    const Quad truth = f.reference(static_cast<Quad>(x));
    const double own = f.own(x);
    if (truth != truth) {
      ASSERT_TRUE(std::isnan(own)) << x;
      return;
    }
    const double error = ulps(own, truth);
    if (!(error <= worst)) {
      worst = error;
      worst_at = x;
    }
  };
  const int count = 1000000;
  for (int i = 0; i < count; ++i) {
    switch (i % 4) {
      case 0:
        check(anyDouble(random));
        break;
      case 1:
        check(uniform(random, f.low, f.high));
        break;
      case 2:
        check(uniform(random, -2, 2));
        break;
      default: {  // all magnitudes except huge and negligible ones
        const double size = std::ldexp(uniform(random, 1, 2), static_cast<int>(random.next() % 80) - 40);
        check(random.next() % 2 ? size : -size);
      }
    }
  }
  // Neighbours of the arguments where method or table changes, and of the ends of the range.
  const auto check_around = [&](double x) {
    for (const double sign : {1.0, -1.0}) {
      double below = sign * x, above = sign * x;
      for (int i = 0; i < 100; ++i) {
        check(below);
        check(above);
        below = std::nextafter(below, -kInfinity);
        above = std::nextafter(above, kInfinity);
        if (!std::isfinite(below)) below = 0;
        if (!std::isfinite(above)) above = 0;
      }
    }
  };
  for (const double x : {0.4, 1.0, 2.0, 22.0, 40.0, 0x1p-7, 0x1p-27, 0x1p-54, 0x1p20, 0x1p53, 0x1p60,
                         1.4140625, 0.70703125, math::kPi / 4})
    check_around(x);
  for (const double x : {709.782712893384, 710.4758600739439, 711.0, 744.4400719213812, 745.1332191019411,
                         0x1p-1022, kSmallest, kLargest})
    check_around(x);
  for (int i = 1; i <= 4096; ++i) {  // midpoints between the entries of the tables
    check(i / 128.0);
    check(i * (math::kPi / 4));
    check(i * 0.010830424696249145 / 2);  // ln 2 / 64
  }
  std::printf("elementary %s arguments=%d max_ulp=%.4f at=%a\n", f.name, count, worst, worst_at);
  EXPECT_LE(worst, 1.0) << f.name << " at " << worst_at;
}

TEST(ElementaryFunctions, SineAndCosineAreAccurateNearTheirZeros) {
  // The doubles nearest to multiples of π/2, among them the nearest of all.
  SplitMix64 random(2);
  double worst = 0;
  const auto check = [&](double x) {
    worst = std::max({worst, ulps(math::sin(x), sinq(static_cast<Quad>(x))),
                      ulps(math::cos(x), cosq(static_cast<Quad>(x)))});
    const math::SineCosine both = math::sincos(x);
    EXPECT_EQ(both.sine, math::sin(x));
    EXPECT_EQ(both.cosine, math::cos(x));
  };
  check(6381956970095103.0 * 0x1p797);
  check(5319372648326541.0 * 0x1p60);
  const Quad half_pi = 2 * atanq(1);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t n = random.next() >> (12 + random.next() % 50);
    const auto x = static_cast<double>(half_pi * static_cast<Quad>(n));
    for (const double y : {std::nextafter(x, 0), x, std::nextafter(x, kInfinity)}) check(i % 2 ? y : -y);
  }
  // Numerators of the convergents of the continued fractions of π/2 and π are especially near.
  for (Quad rest : {half_pi, 2 * half_pi}) {
    Quad before = 0, numerator = 1;
    while (numerator < 0x1p53) {
      const auto whole = static_cast<Quad>(static_cast<std::int64_t>(rest));
      before = std::exchange(numerator, whole * numerator + before);
      rest = 1 / (rest - whole);
      for (int i = 0; i < 900; ++i) check(std::ldexp(static_cast<double>(numerator), i));
    }
  }
  std::printf("elementary sincos next to zeros max_ulp=%.4f\n", worst);
  EXPECT_LE(worst, 1.0);
}

TEST(ElementaryFunctions, Atan2IsWithinOneUlp) {
  SplitMix64 random(3);
  double worst = 0, worst_x = 0, worst_y = 0;
  const auto check = [&](double y, double x) {
    const double error = ulps(math::atan2(y, x), atan2q(static_cast<Quad>(y), static_cast<Quad>(x)));
    if (!(error <= worst)) {
      worst = error;
      worst_x = x;
      worst_y = y;
    }
  };
  for (int i = 0; i < 1000000; ++i) {
    if (i % 3 == 0) {
      check(anyDouble(random), anyDouble(random));
    } else if (i % 3 == 1) {
      check(uniform(random, -1, 1), uniform(random, -1, 1));
    } else {
      const double x = anyDouble(random);
      check(std::ldexp(uniform(random, -2, 2), std::ilogb(x) + static_cast<int>(random.next() % 128) - 64),
            x);
    }
  }
  for (int i = 0; i <= 64; ++i) {
    for (const double x : {1.0, 3.0, -1.0, 0x1p-1060, -0x1p1000}) {
      check(x * i / 32, x);
      check(std::nextafter(x * i / 32, 0), x);
      check(-x, x * i / 32);
    }
  }
  std::printf("elementary atan2 arguments=1000000 max_ulp=%.4f at=%a,%a\n", worst, worst_y, worst_x);
  EXPECT_LE(worst, 1.0) << worst_y << ", " << worst_x;
}

void expectSame(double value, double expected, const char* what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(value)) << what;
  } else {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected))
        << what << ": " << value << " instead of " << expected;
  }
}
#define EXPECT_SAME(value, expected) expectSame(value, expected, #value)

TEST(ElementaryFunctions, SpecialValuesFollowTheCStandard) {
  for (const Function& f : kFunctions) EXPECT_TRUE(std::isnan(f.own(kNaN))) << f.name;
  for (const auto odd :
       {math::expm1, math::log1p, math::sin, math::tanh, math::sinh, math::atan, math::asin}) {
    for (const double x : {0.0, -0.0, kSmallest, -kSmallest}) EXPECT_SAME(odd(x), x);
  }
  EXPECT_SAME(math::exp(-0.0), 1);
  EXPECT_SAME(math::exp(kInfinity), kInfinity);
  EXPECT_SAME(math::exp(-kInfinity), 0);
  EXPECT_SAME(math::exp(1000), kInfinity);
  EXPECT_SAME(math::exp(-1000), 0);
  EXPECT_SAME(math::exp(-745.1332191019411), kSmallest);
  EXPECT_SAME(math::expm1(kInfinity), kInfinity);
  EXPECT_SAME(math::expm1(-kInfinity), -1);
  EXPECT_SAME(math::log(0.0), -kInfinity);
  EXPECT_SAME(math::log(-0.0), -kInfinity);
  EXPECT_SAME(math::log(1), 0);
  EXPECT_SAME(math::log(-1), kNaN);
  EXPECT_SAME(math::log(kInfinity), kInfinity);
  EXPECT_SAME(math::log1p(-1), -kInfinity);
  EXPECT_SAME(math::log1p(-1.5), kNaN);
  EXPECT_SAME(math::log1p(kInfinity), kInfinity);
  EXPECT_SAME(math::sin(kInfinity), kNaN);
  EXPECT_SAME(math::cos(-kInfinity), kNaN);
  EXPECT_SAME(math::cos(-0.0), 1);
  EXPECT_SAME(math::sincos(-0.0).sine, -0.0);
  EXPECT_SAME(math::tanh(kInfinity), 1);
  EXPECT_SAME(math::tanh(-kInfinity), -1);
  EXPECT_SAME(math::sinh(-kInfinity), -kInfinity);
  EXPECT_SAME(math::cosh(-kInfinity), kInfinity);
  EXPECT_SAME(math::cosh(0), 1);
  EXPECT_SAME(math::atan(kInfinity), math::kPi / 2);
  EXPECT_SAME(math::asin(1.5), kNaN);
  EXPECT_SAME(math::acos(-1.5), kNaN);
  EXPECT_SAME(math::acos(1), 0);
  EXPECT_SAME(math::acos(-1), math::kPi);
  for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, kSmallest, -kLargest, kNaN}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, -kSmallest, kLargest, kNaN}) {
      EXPECT_SAME(math::atan2(y, x), std::atan2(y, x));  // exact results here by annex F of the C standard
    }
  }
}

// A hash of a million results. It must not depend on compiler or optimization level.
TEST(ElementaryFunctions, HashIsTheSameOnEveryPlatform) {
  SplitMix64 random(4);
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](double value) {
    const std::uint64_t bits = std::isnan(value) ? 0x7ff8 : std::bit_cast<std::uint64_t>(value);
    hash = (hash ^ bits) * 0x100000001b3;
    hash ^= hash >> 32;
  };
  for (int i = 0; i < 80000; ++i) {
    const double x = i % 2 ? anyDouble(random) : uniform(random, -30, 30);
    for (const Function& f : kFunctions) add(f.own(x));
    add(math::atan2(x, uniform(random, -30, 30)));
  }
  EXPECT_EQ(hash, 0x0c580406d689725aULL) << std::hex << hash;
}

}  // namespace
}  // namespace df
