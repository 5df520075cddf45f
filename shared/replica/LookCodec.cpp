#include "shared/replica/LookCodec.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "shared/replica/Limits.h"
#include "shared/replica/MotionCodec.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   look        altitude 2: 1, else 0 and 8 bits | kind 2: 0 nothing, 1 a character (character, colour),
//               2 in full (named 1 | id 12 if named | sequence | selector), 3 named (id 12 | selector)
//   sequence    one: 1, else 0 and count - 2: exp-Golomb(3) | whole 1 (half x 1, half y 1)
//               | each: appearance
//   appearance  glyphs: exp-Golomb(3) | each: if whole: plain 1 | unless plain: moved 1, recoloured 1
//               | if whole: the same character 1 | character, unless the same | dx, dy if moved: signed
//               exp-Golomb, of order 8, or in cells of order 1 if whole | colour 3 if recoloured
//   selector    always the first: 1, else 0 | kind 2: 0 fixed (frame 8), 1 clock, 2 clock once (ticks - 1:
//               exp-Golomb(3) | age: exp-Golomb(6)), 3 angle (code 3 | upper bits | width 6 | spin)
//   character   wide 1 | 7 bits, or 14
//   body        usual box: 1, else 0 and its vectors | solidness 2 | no-soft 1
namespace {

using look_codec::Kind;

constexpr std::int32_t kUsualAltitude = 2;
constexpr int kAltitudeBits = 8;
constexpr int kNarrowBits = 7;
constexpr int kWideBits = 14;
constexpr int kColorBits = 3;
constexpr int kGlyphCountOrder = 3;
constexpr int kOffsetOrder = 8;
constexpr int kCellOrder = 1;
constexpr int kFrameCountOrder = 3;
constexpr int kFrameBits = 8;
constexpr int kTicksOrder = 3;
constexpr int kAgeOrder = 6;
constexpr int kAngleCodeBits = 3;  ///< the angle is sent as 4 (code + 1) upper bits
constexpr int kSpinWidthBits = 6;
constexpr std::int64_t kGlyphStep = 1 << kGlyphUnitBits;
constexpr df::Fixed kMaxBoxCorner = df::Fixed{1'000'001} << df::kFixedBits;

constexpr std::int32_t kHalfCell = 1 << (kGlyphUnitBits - 1);

/// Returns the glyph that the first glyph is encoded relative to.
Glyph beforeFirst(CellPosition fraction) {
  return {fraction.x - (1 << kGlyphUnitBits), fraction.y, U' ', df::COLOR_DEFAULT};
}

}  // namespace

bool isSingleCharacter(const Sequence& sequence) {
  return sequence.size() == 1 && sequence.glyphCount() == 1 && sequence.reach() == 0;
}

void writeCharacter(BitWriter& out, char32_t ch) {
  const bool wide = ch >> kNarrowBits != 0;
  out.flag(wide);
  out.bits(ch, wide ? kWideBits : kNarrowBits);
}

char32_t readCharacter(BitReader& in) {
  const bool wide = in.flag();
  const auto ch = static_cast<char32_t>(in.bits(wide ? kWideBits : kNarrowBits));
  if (!df::isDrawable(ch)) in.fail();
  return ch;
}

void writeColor(BitWriter& out, df::Color color) {
  out.bits(static_cast<std::uint64_t>(color), kColorBits);
}

df::Color readColor(BitReader& in) {
  static_assert(df::kColorCount == 1 << kColorBits);
  return static_cast<df::Color>(in.bits(kColorBits));
}

namespace {

// Neighbouring characters of a string differ only by one cell in x. So offsets are encoded relative to the
// cell right of the previous character, and colour and row only if they change.
void writeAppearance(BitWriter& out, const Appearance& glyphs, bool whole, CellPosition fraction) {
  out.golomb(glyphs.size(), kGlyphCountOrder);
  Glyph last = beforeFirst(fraction);
  const int order = whole ? kCellOrder : kOffsetOrder;
  const std::int64_t unit = whole ? kGlyphStep : 1;
  for (const Glyph& glyph : glyphs) {
    const bool moved = glyph.dx != last.dx + kGlyphStep || glyph.dy != last.dy;
    const bool recolored = glyph.color != last.color;
    const bool plain = whole && !moved && !recolored;
    if (whole) out.flag(plain);
    if (!plain) out.flag(moved);
    if (!plain) out.flag(recolored);
    if (whole) out.flag(glyph.ch == last.ch);
    if (!whole || glyph.ch != last.ch) writeCharacter(out, glyph.ch);
    if (moved) {
      out.signedGolomb((std::int64_t{glyph.dx} - last.dx - kGlyphStep) / unit, order);
      out.signedGolomb((std::int64_t{glyph.dy} - last.dy) / unit, order);
    }
    if (recolored) writeColor(out, glyph.color);
    last = glyph;
  }
}

/// `room`: number of further glyphs allowed.
Appearance readAppearance(BitReader& in, bool whole, CellPosition fraction, std::size_t& room) {
  Appearance glyphs;
  const std::uint64_t count = in.golomb(kGlyphCountOrder, room);
  const int order = whole ? kCellOrder : kOffsetOrder;
  const std::int64_t unit = whole ? kGlyphStep : 1;
  const std::int64_t most = 4 * kMaxGlyphOffset / unit;
  Glyph last = beforeFirst(fraction);
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    const bool plain = whole && in.flag();
    const bool moved = !plain && in.flag();
    const bool recolored = !plain && in.flag();
    const bool same = whole && in.flag();
    const char32_t ch = same ? last.ch : readCharacter(in);
    std::int64_t dx = last.dx + kGlyphStep;
    std::int64_t dy = last.dy;
    if (moved) {
      dx += in.signedGolomb(order, most) * unit;
      dy += in.signedGolomb(order, most) * unit;
    }
    if (std::max(std::abs(dx), std::abs(dy)) > kMaxGlyphOffset) in.fail();
    const df::Color color = recolored ? readColor(in) : last.color;
    if (!in.ok()) break;
    last = {static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy), ch, color};
    glyphs.push_back(last);
  }
  room -= glyphs.size();
  return glyphs;
}

}  // namespace

void writeSequence(BitWriter& out, const Sequence& sequence) {
  assert(!sequence.empty() && sequence.size() <= kMaxFrames && sequence.glyphCount() <= kMaxGlyphs);
  out.flag(sequence.size() == 1);
  if (sequence.size() > 1) out.golomb(sequence.size() - 2, kFrameCountOrder);
  const bool whole = sequence.isWhole();
  const CellPosition fraction = whole ? sequence.fraction() : CellPosition{};
  out.flag(whole);
  if (whole) out.flag(fraction.x != 0);
  if (whole) out.flag(fraction.y != 0);
  for (const Appearance& appearance : sequence) writeAppearance(out, appearance, whole, fraction);
}

Sequence readSequence(BitReader& in) {
  const std::uint64_t count = in.flag() ? 1 : 2 + in.golomb(kFrameCountOrder, kMaxFrames - 2);
  const bool whole = in.flag();
  CellPosition fraction;
  if (whole && in.flag()) fraction.x = kHalfCell;
  if (whole && in.flag()) fraction.y = kHalfCell;
  std::size_t room = kMaxGlyphs;
  std::vector<Appearance> frames;
  for (std::uint64_t i = 0; i < count && in.ok(); ++i)
    frames.push_back(readAppearance(in, whole, fraction, room));
  return Sequence(std::move(frames));
}

std::size_t encodedBits(const Sequence& sequence) {
  if (sequence.empty()) return 0;
  BitWriter out;
  writeSequence(out, sequence);
  return out.bitCount();
}

void writeSelector(BitWriter& out, const Selector& selector, std::uint32_t tick, std::size_t frames) {
  assert(selector.fits(frames));
  const bool first = selector == Selector{};
  out.flag(first);
  if (first) return;
  out.bits(selector.kind, 2);
  switch (selector.kind) {
    case Selector::kFixed:
      return out.bits(selector.frame, kFrameBits);
    case Selector::kClock:
    case Selector::kClockOnce:
      out.golomb(selector.ticks_per_frame - 1, kTicksOrder);
      return out.golomb(selector.age(tick, frames), kAgeOrder);
    case Selector::kAngle:
      break;
  }
  const int zeros = selector.angle == 0 ? 32 : std::countr_zero(selector.angle);
  const int sent = 32 - std::min(zeros / 4 * 4, 28);
  out.bits(static_cast<std::uint64_t>(sent / 4 - 1), kAngleCodeBits);
  out.bits(selector.angle >> (32 - sent), sent);
  const auto magnitude = static_cast<std::uint32_t>(selector.spin < 0 ? ~selector.spin : selector.spin);
  const int width = selector.spin == 0 ? 0 : std::bit_width(magnitude) + 1;
  out.bits(static_cast<std::uint64_t>(width), kSpinWidthBits);
  out.signedBits(selector.spin, width);
}

// Does not check whether the selector fits its sequence, because the sequence's id may be defined later.
Selector readSelector(BitReader& in, std::uint32_t tick) {
  Selector selector;
  if (in.flag()) return selector;
  selector.kind = static_cast<Selector::Kind>(in.bits(2));
  switch (selector.kind) {
    case Selector::kFixed:
      selector.frame = static_cast<std::uint8_t>(in.bits(kFrameBits));
      break;
    case Selector::kClock:
    case Selector::kClockOnce:
      selector.ticks_per_frame =
          1 + static_cast<std::uint32_t>(in.golomb(kTicksOrder, kMaxTicksPerFrame - 1));
      selector.start =
          tick - static_cast<std::uint32_t>(in.golomb(kAgeOrder, kMaxFrames * kMaxTicksPerFrame - 1));
      break;
    case Selector::kAngle: {
      const int sent = 4 * (static_cast<int>(in.bits(kAngleCodeBits)) + 1);
      selector.angle = static_cast<std::uint32_t>(in.bits(sent) << (32 - sent));
      const int width = static_cast<int>(in.bits(kSpinWidthBits));
      if (width > 32) in.fail();
      selector.spin = in.ok() ? static_cast<std::int32_t>(in.signedBits(width)) : 0;
      break;
    }
  }
  return selector;
}

void writeLook(BitWriter& out, const Look& look, LookForm form, std::uint32_t tick) {
  assert(look.altitude >= 0 && look.altitude >> kAltitudeBits == 0);
  const bool usual = look.altitude == kUsualAltitude;
  out.flag(usual);
  if (!usual) out.bits(static_cast<std::uint64_t>(look.altitude), kAltitudeBits);
  const auto kind = [&out](Kind k) { out.bits(static_cast<std::uint64_t>(k), 2); };
  if (look.sequence.empty()) return kind(Kind::kNothing);
  if (isSingleCharacter(look.sequence)) {
    const Glyph& glyph = look.sequence.front().front();
    kind(Kind::kCharacter);
    writeCharacter(out, glyph.ch);
    return writeColor(out, glyph.color);
  }
  if (form.kind == LookForm::kNamed) {
    kind(Kind::kNamed);
    out.bits(form.id, kAppearanceIdBits);
  } else {
    kind(Kind::kInline);
    out.flag(form.kind == LookForm::kDefined);
    if (form.kind == LookForm::kDefined) out.bits(form.id, kAppearanceIdBits);
    writeSequence(out, look.sequence);
  }
  writeSelector(out, look.selector, tick, look.sequence.size());
}

namespace look_codec {

std::int32_t readAltitude(BitReader& in) {
  return in.flag() ? kUsualAltitude : static_cast<std::int32_t>(in.bits(kAltitudeBits));
}

Kind readKind(BitReader& in) {
  return static_cast<Kind>(in.bits(2));
}

Appearance readSingle(BitReader& in) {
  const char32_t ch = readCharacter(in);
  const df::Color color = readColor(in);
  return {Glyph{0, 0, ch, color}};
}

}  // namespace look_codec

std::uint64_t wireSolidness(const Body& body) {
  assert(!body.on_view || body.solidness == df::SPECTRAL);
  return body.on_view ? kOnViewSolidness : static_cast<std::uint64_t>(body.solidness);
}

void writeBody(BitWriter& out, const Body& body) {
  const bool usual = body.box == Body{}.box;
  out.flag(usual);
  if (!usual) {
    writeVector(out, body.box.corner);
    writeVector(out, body.box.size);
  }
  out.bits(wireSolidness(body), 2);
  out.flag(body.no_soft);
}

Body readBody(BitReader& in) {
  Body body;
  if (!in.flag()) {
    body.box.corner = readVector(in, kMaxBoxCorner);
    body.box.size = readVector(in, kMaxBoxCorner);
    if (body.box.size.x < 0 || body.box.size.y < 0) in.fail();
  }
  const std::uint64_t solidness = in.bits(2);
  body.on_view = solidness == kOnViewSolidness;
  body.solidness = body.on_view ? df::SPECTRAL : static_cast<df::Solidness>(solidness);
  body.no_soft = in.flag();
  return body;
}

}  // namespace naiad
