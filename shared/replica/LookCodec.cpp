#include "LookCodec.h"

#include <algorithm>
#include <cstdlib>

#include "Limits.h"
#include "MotionCodec.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   look        altitude is 2: 1, else 0 and 8 bits | kind 2: 0 nothing, 1 a character (character, colour),
//               2 spelled (named 1 | id 12 if named | appearance), 3 named (id 12)
//   appearance  glyphs: exp-Golomb(3) | each: moved 1, recoloured 1 | character | dx, dy if moved: signed
//               exp-Golomb(8) | colour 3 if recoloured
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
constexpr std::int64_t kGlyphStep = 1 << kGlyphUnitBits;
constexpr df::Fixed kMaxBoxCorner = df::Fixed{1'000'001} << df::kFixedBits;

/// What the first glyph is written as a difference to.
constexpr Glyph kBeforeFirst{-(1 << kGlyphUnitBits), 0, U' ', df::COLOR_DEFAULT};

}  // namespace

bool isSingleCharacter(const Appearance& appearance) {
  return appearance.size() == 1 && appearance[0].dx == 0 && appearance[0].dy == 0;
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

// Neighbouring characters of a string differ by one cell in x and nothing else, so offsets are written as
// differences from "one cell to the right", and colour and row only where they change.
void writeAppearance(BitWriter& out, const Appearance& glyphs) {
  assert(glyphs.size() <= kMaxGlyphs);
  out.golomb(glyphs.size(), kGlyphCountOrder);
  Glyph last = kBeforeFirst;
  for (const Glyph& glyph : glyphs) {
    const bool moved = glyph.dx != last.dx + kGlyphStep || glyph.dy != last.dy;
    const bool recolored = glyph.color != last.color;
    out.flag(moved);
    out.flag(recolored);
    writeCharacter(out, glyph.ch);
    if (moved) {
      out.signedGolomb(std::int64_t{glyph.dx} - last.dx - kGlyphStep, kOffsetOrder);
      out.signedGolomb(std::int64_t{glyph.dy} - last.dy, kOffsetOrder);
    }
    if (recolored) writeColor(out, glyph.color);
    last = glyph;
  }
}

Appearance readAppearance(BitReader& in) {
  Appearance glyphs;
  const std::uint64_t count = in.golomb(kGlyphCountOrder, kMaxGlyphs);
  Glyph last = kBeforeFirst;
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    const bool moved = in.flag();
    const bool recolored = in.flag();
    const char32_t ch = readCharacter(in);
    std::int64_t dx = last.dx + kGlyphStep;
    std::int64_t dy = last.dy;
    if (moved) {
      dx += in.signedGolomb(kOffsetOrder, 4 * kMaxGlyphOffset);
      dy += in.signedGolomb(kOffsetOrder, 4 * kMaxGlyphOffset);
    }
    if (std::max(std::abs(dx), std::abs(dy)) > kMaxGlyphOffset) in.fail();
    const df::Color color = recolored ? readColor(in) : last.color;
    if (!in.ok()) break;
    last = {static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy), ch, color};
    glyphs.push_back(last);
  }
  return glyphs;
}

std::size_t encodedBits(const Appearance& appearance) {
  BitWriter out;
  writeAppearance(out, appearance);
  return out.bitCount();
}

void writeLook(BitWriter& out, const Look& look, LookForm form) {
  assert(look.sequence.size() <= 1 && look.altitude >= 0 && look.altitude >> kAltitudeBits == 0);
  const bool usual = look.altitude == kUsualAltitude;
  out.flag(usual);
  if (!usual) out.bits(static_cast<std::uint64_t>(look.altitude), kAltitudeBits);
  const auto kind = [&out](Kind k) { out.bits(static_cast<std::uint64_t>(k), 2); };
  if (look.sequence.empty()) return kind(Kind::kNothing);
  const Appearance& appearance = look.sequence.front();
  if (isSingleCharacter(appearance)) {
    kind(Kind::kCharacter);
    writeCharacter(out, appearance[0].ch);
    return writeColor(out, appearance[0].color);
  }
  if (form.kind == LookForm::kNamed) {
    kind(Kind::kNamed);
    return out.bits(form.id, kAppearanceIdBits);
  }
  kind(Kind::kSpelled);
  out.flag(form.kind == LookForm::kDefined);
  if (form.kind == LookForm::kDefined) out.bits(form.id, kAppearanceIdBits);
  writeAppearance(out, appearance);
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

void writeBody(BitWriter& out, const Body& body) {
  const bool usual = body.box == Body{}.box;
  out.flag(usual);
  if (!usual) {
    writeVector(out, body.box.corner);
    writeVector(out, body.box.size);
  }
  out.bits(body.solidness, 2);
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
  if (solidness > df::SPECTRAL) in.fail();
  body.solidness = static_cast<df::Solidness>(in.ok() ? solidness : 0);
  body.no_soft = in.flag();
  return body;
}

}  // namespace naiad
