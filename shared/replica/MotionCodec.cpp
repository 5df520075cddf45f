#include "shared/replica/MotionCodec.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "shared/values/FixedRange.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   motion    near 1 | cell: x_bits, y_bits if near, else two signed exp-Golomb(10) | kind 2 | position's
//             fraction | velocity if kind >= 1 | acceleration if kind = 2
//   fraction  code 4 | bits of x, bits of y
//   velocity  code 4 | width − fractional bits: signed exp-Golomb(1) | x, y: width bits each
namespace {

enum MotionKind : std::uint8_t { kStill = 0, kLinear = 1, kAccelerated = 2 };

/// The numbers of fractional bits that a code of four bits selects.
constexpr std::array<int, 16> kFractions = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 16, 22, 32};
constexpr int kFractionCodeBits = 4;
constexpr int kFarOrder = 10;

int codeFor(df::FixedVector v) {
  const auto all = static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y);
  const int needed = std::max(0, df::kFixedBits - std::countr_zero(all));
  return static_cast<int>(std::lower_bound(kFractions.begin(), kFractions.end(), needed) -
                          kFractions.begin());
}

/// Returns the number of bits that a number needs in two's complement; 0 for 0.
int widthOf(std::int64_t value) {
  return value == 0 ? 0 : std::bit_width(static_cast<std::uint64_t>(value < 0 ? ~value : value)) + 1;
}

void writeSteps(BitWriter& out, df::FixedVector v) {
  const int code = codeFor(v);
  const int fraction = kFractions[static_cast<std::size_t>(code)];
  const std::int64_t x = v.x >> (df::kFixedBits - fraction);
  const std::int64_t y = v.y >> (df::kFixedBits - fraction);
  const int width = std::max(widthOf(x), widthOf(y));
  out.bits(static_cast<std::uint64_t>(code), kFractionCodeBits);
  out.signedGolomb(width - fraction, 1);
  out.signedBits(x, width);
  out.signedBits(y, width);
}

df::FixedVector readSteps(BitReader& in, df::Fixed most) {
  const int fraction = kFractions[in.bits(kFractionCodeBits)];
  const auto width = fraction + static_cast<int>(in.signedGolomb(1, 64));
  // More bits cannot be a valid number of steps.
  if (width < 0 || width > 64 - (df::kFixedBits - fraction)) {
    in.fail();
    return {};
  }
  const int shift = df::kFixedBits - fraction;
  const auto step = [&] {
    return static_cast<df::Fixed>(static_cast<std::uint64_t>(in.signedBits(width)) << shift);
  };
  const df::Fixed x = step();
  const df::FixedVector v{x, step()};
  if (!isWithin(v, most)) in.fail();
  return v;
}

bool isNear(const Origin& origin, std::int64_t x, std::int64_t y) {
  return x >= 0 && y >= 0 && x >> origin.x_bits == 0 && y >> origin.y_bits == 0;
}

// Adds half a cell to positions, so that the whole part is the cell in which they are drawn.
constexpr df::Fixed kHalf = df::kFixedOne / 2;

df::FixedVector shifted(df::FixedVector v, df::Fixed by) {
  return {v.x + by, v.y + by};
}

void writePosition(BitWriter& out, df::FixedVector position, const Origin& origin) {
  const df::FixedVector p = shifted(position, kHalf);
  const std::int64_t x = (p.x >> df::kFixedBits) - origin.corner.x;
  const std::int64_t y = (p.y >> df::kFixedBits) - origin.corner.y;
  out.flag(isNear(origin, x, y));
  if (isNear(origin, x, y)) {
    out.bits(static_cast<std::uint64_t>(x), origin.x_bits);
    out.bits(static_cast<std::uint64_t>(y), origin.y_bits);
  } else {
    out.signedGolomb(x, kFarOrder);
    out.signedGolomb(y, kFarOrder);
  }
}

// Encodes the fraction of the position itself, not of position + 1/2: the middle of a cell is a whole number,
// so most fractions are short.
void writeFraction(BitWriter& out, df::FixedVector position) {
  constexpr df::Fixed kMask = df::kFixedOne - 1;
  const df::FixedVector fraction{position.x & kMask, position.y & kMask};
  const int code = codeFor(fraction);
  const int bits = kFractions[static_cast<std::size_t>(code)];
  out.bits(static_cast<std::uint64_t>(code), kFractionCodeBits);
  out.bits(static_cast<std::uint64_t>(fraction.x) >> (df::kFixedBits - bits), bits);
  out.bits(static_cast<std::uint64_t>(fraction.y) >> (df::kFixedBits - bits), bits);
}

CellPosition readCell(BitReader& in, const Origin& origin) {
  constexpr std::int64_t kMaxCells = std::int64_t{1} << 32;
  const bool near = in.flag();
  const auto cell = [&](int bits) {
    return near ? static_cast<std::int64_t>(in.bits(bits)) : in.signedGolomb(kFarOrder, kMaxCells);
  };
  const std::int64_t x = cell(origin.x_bits) + origin.corner.x;
  const std::int64_t y = cell(origin.y_bits) + origin.corner.y;
  if (x != static_cast<std::int32_t>(x) || y != static_cast<std::int32_t>(y)) in.fail();
  return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

// Returns the coordinate c with this cell and fraction. The cell is that of c + 1/2, so it is one above the
// whole part of c if the fraction is at least 1/2.
df::Fixed joined(std::int32_t cell, std::uint64_t fraction) {
  // Unsigned, because the smallest cell may overflow: it wraps to a position that is refused.
  const std::uint64_t upper = static_cast<std::uint64_t>(std::int64_t{cell}) - (fraction >= kHalf ? 1 : 0);
  return static_cast<df::Fixed>((upper << df::kFixedBits) + fraction);
}

df::FixedVector readFraction(BitReader& in, CellPosition cell) {
  const int bits = kFractions[in.bits(kFractionCodeBits)];
  const std::uint64_t x = in.bits(bits) << (df::kFixedBits - bits);
  const std::uint64_t y = in.bits(bits) << (df::kFixedBits - bits);
  const df::FixedVector position{joined(cell.x, x), joined(cell.y, y)};
  if (!isWithin(position, kMaxWirePosition)) in.fail();
  return position;
}

void writeBehindCell(BitWriter& out, const Motion& m) {
  const df::FixedVector zero;
  const auto kind = m.acceleration != zero ? kAccelerated : m.velocity != zero ? kLinear : kStill;
  out.bits(kind, 2);
  writeFraction(out, m.position);
  if (kind != kStill) writeSteps(out, m.velocity);
  if (kind == kAccelerated) writeSteps(out, m.acceleration);
}

}  // namespace

int fractionBits(df::FixedVector v) {
  return kFractions[static_cast<std::size_t>(codeFor(v))];
}

void writeMotion(BitWriter& out, const Motion& m, const Origin& origin) {
  writePosition(out, m.position, origin);
  writeBehindCell(out, m);
}

SharedMotion shareMotion(const Motion& motion) {
  BitWriter behind;
  writeBehindCell(behind, motion);
  if (behind.bitCount() >= 64) return {motion, 0, 0};
  return {motion, behind.value(), static_cast<int>(behind.bitCount())};
}

void writeMotion(BitWriter& out, const SharedMotion& shared, const Origin& origin) {
  if (shared.count == 0) return writeMotion(out, shared.motion, origin);
  writePosition(out, shared.motion.position, origin);
  out.bits(shared.bits, shared.count);
}

Motion readMotion(BitReader& in, std::uint32_t tick, const Origin& origin) {
  Motion m;
  m.tick = tick;
  const CellPosition cell = readCell(in, origin);
  const std::uint64_t kind = in.bits(2);
  if (kind > kAccelerated) in.fail();
  m.position = readFraction(in, cell);
  if (kind != kStill) m.velocity = readSteps(in, kMaxWireVelocity);
  if (kind == kAccelerated) m.acceleration = readSteps(in, kMaxWireVelocity);
  return m;
}

void writeVector(BitWriter& out, df::FixedVector v) {
  writePosition(out, v, {});
  writeFraction(out, v);
}

df::FixedVector readVector(BitReader& in, df::Fixed most) {
  const CellPosition cell = readCell(in, {});
  const df::FixedVector v = readFraction(in, cell);
  if (!isWithin(v, most)) in.fail();
  return v;
}

}  // namespace naiad
