#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "shared/math/DoubleDouble.h"
#include "shared/math/Elementary.h"

namespace df::math {

namespace {

__extension__ typedef unsigned __int128 Wide;

constexpr double kHalfPiHead = 0x1.921fb54442d18p+0;
constexpr double kHalfPiTail = 0x1.1a62633145c07p-54;

// An angle as a number of right angles, modulo 4, and the rest in [−π/4, π/4] (a little beyond if rounded).
struct Reduced {
  DoubleDouble rest;
  unsigned quadrant;
};

// Cody and Waite: π/2 in parts of 33 bits, whose products with fewer than 2^20 right angles are exact.
constexpr double kCodyWaiteLimit = 0x1p20;
Reduced reduceModerate(double x) {
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2ep-69,
                   kPart4 = 0x1.b839a252049c1p-104;
  const double n = rounded(x * 0x1.45f306dc9c883p-1);
  const DoubleDouble second = twoSum(x - n * kPart1, -(n * kPart2));
  const DoubleDouble third = twoSum(second.hi, -(n * kPart3));
  const DoubleDouble rest = twoSum(third.hi, second.lo + (third.lo - n * kPart4));
  return {rest, static_cast<unsigned>(static_cast<int>(n)) & 3};
}

// Payne and Hanek: computes only the relevant bits of x · 2/π, in integers.
//
// The first 1280 bits of 2/π behind the point, after a word of zeros for arguments with fractional bits.
constexpr std::array<std::uint64_t, 21> kTwoOverPi = {
    0,
    0xa2f9836e4e441529,
    0xfc2757d1f534ddc0,
    0xdb6295993c439041,
    0xfe5163abdebbc561,
    0xb7246e3a424dd2e0,
    0x06492eea09d1921c,
    0xfe1deb1cb129a73e,
    0xe88235f52ebb4484,
    0xe99c7026b45f7e41,
    0x3991d639835339f4,
    0x9c845f8bbdf9283b,
    0x1ff897ffde05980f,
    0xef2f118b5a0a6d1f,
    0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b,
    0x3d0739f78a5292ea,
    0x6bfb5fb11f8d5d08,
    0x56033046fc7b6bab,
    0xf0cfbc209af4361d,
};

Reduced reduceLarge(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t mantissa = (bits & 0xfffffffffffffULL) | 0x10000000000000ULL;
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1075;  // x = mantissa · 2^exponent

  // 192 bits of 2/π beginning with the bit of weight 2^(1 − exponent): earlier ones give whole turns.
  const unsigned start = static_cast<unsigned>(64 + exponent - 2);
  const unsigned word = start / 64, shift = start % 64;
  const auto window = [&](unsigned i) {
    const std::uint64_t upper = kTwoOverPi[word + i], lower = kTwoOverPi[word + i + 1];
    return shift == 0 ? upper : upper << shift | lower >> (64 - shift);
  };
  // mantissa · window, modulo one turn: the fraction of a turn, in 192 bits.
  const Wide low = static_cast<Wide>(mantissa) * window(2);
  const Wide middle = static_cast<Wide>(mantissa) * window(1) + static_cast<std::uint64_t>(low >> 64);
  std::uint64_t w0 = static_cast<std::uint64_t>(low), w1 = static_cast<std::uint64_t>(middle);
  std::uint64_t w2 = mantissa * window(0) + static_cast<std::uint64_t>(middle >> 64);

  unsigned quadrant = static_cast<unsigned>(w2 >> 62);
  w2 = w2 << 2 | w1 >> 62;  // now the fraction of a right angle
  w1 = w1 << 2 | w0 >> 62;
  w0 <<= 2;
  const bool beyond_half = w2 >> 63;
  if (beyond_half) {  // measure down from the next right angle
    ++quadrant;
    w0 = ~w0, w1 = ~w1, w2 = ~w2;  // ~w is −w − 1: an error of 2^-192, which is negligible
  }
  DoubleDouble fraction{};
  double weight = 0x1p-192;
  for (const std::uint64_t w : {w0, w1, w2}) {
    for (const std::uint64_t half : {w & 0xffffffff, w >> 32}) {
      const DoubleDouble sum = twoSum(static_cast<double>(half) * weight, fraction.hi);
      fraction = {sum.hi, sum.lo + fraction.lo};
      weight *= 0x1p32;
    }
  }
  DoubleDouble rest = fraction * DoubleDouble{kHalfPiHead, kHalfPiTail};
  if (beyond_half) rest = -rest;
  if (bits >> 63) {
    rest = -rest;
    quadrant = 0U - quadrant;
  }
  return {rest, quadrant & 3};
}

Reduced reduce(double x) {
  if (x >= -kPi / 4 && x <= kPi / 4) return {{x, 0}, 0};
  return x > -kCodyWaiteLimit && x < kCodyWaiteLimit ? reduceModerate(x) : reduceLarge(x);
}

// Taylor series; at π/4 the omitted terms are below 2^-62.
double sineOf(DoubleDouble r) {
  const double z = r.hi * r.hi, z2 = z * z;
  const double series =
      (-1.0 / 6 + z * (1.0 / 120)) + z2 * ((-1.0 / 5040 + z * (1.0 / 362880)) +
                                           z2 * ((-1.0 / 39916800 + z * (1.0 / 6227020800)) +
                                                 z2 * (-1.0 / 1307674368000 + z * (1.0 / 355687428096000))));
  return r.hi + (r.hi * z * series + r.lo * (1 - 0.5 * z));
}

double cosineOf(DoubleDouble r) {
  const DoubleDouble square = twoProduct(r.hi, r.hi);
  const double z = square.hi, z2 = z * z;
  const double series = (1.0 / 24 + z * (-1.0 / 720)) +
                        z2 * ((1.0 / 40320 + z * (-1.0 / 3628800)) +
                              z2 * ((1.0 / 479001600 + z * (-1.0 / 87178291200)) +
                                    z2 * (1.0 / 20922789888000 + z * (-1.0 / 6402373705728000))));
  const DoubleDouble head = fastTwoSum(1, -0.5 * z);
  return head.hi + (head.lo + (z2 * series - (0.5 * square.lo + r.hi * r.lo)));
}

constexpr bool isFinite(double x) {
  return x - x == 0;
}

}  // namespace

SineCosine sincos(double x) {
  if (!isFinite(x)) return {x - x, x - x};
  if (x > -0x1p-27 && x < 0x1p-27) return {x, 1};
  const Reduced angle = reduce(x);
  const double sine = sineOf(angle.rest), cosine = cosineOf(angle.rest);
  switch (angle.quadrant) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

double sin(double x) {
  if (!isFinite(x)) return x - x;
  if (x > -0x1p-27 && x < 0x1p-27) return x;
  const Reduced angle = reduce(x);
  const double value = angle.quadrant & 1 ? cosineOf(angle.rest) : sineOf(angle.rest);
  return angle.quadrant & 2 ? -value : value;
}

double cos(double x) {
  if (!isFinite(x)) return x - x;
  const Reduced angle = reduce(x);
  const double value = angle.quadrant & 1 ? sineOf(angle.rest) : cosineOf(angle.rest);
  return angle.quadrant == 1 || angle.quadrant == 2 ? -value : value;
}

}  // namespace df::math
