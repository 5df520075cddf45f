#include "RecordCodec.h"

#include <algorithm>
#include <cassert>

#include "Bytes.h"
#include "Limits.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   world   01 | corner x y, width, height of the boundary (zz zz v v) | view width, height (v v)
//   view    02 | corner x y (zz zz) | slot + 1, generation (v v); slot part 0: follows nobody
//   text    03 | id (v) | x y (zz zz) | colour (1) | length (v), UTF-8
//   object  10 + groups | slot, generation (v v) | life? order (v) | motion? | look? | body?
//           (groups 0: dead)
//   motion  kind (1): 0 still, 1 linear, 2 accelerated | position (zz zz) | velocity (zz zz) | acceleration
//   look    altitude (v) | appearances (v) | each: glyphs (v) | each: run byte …
//   body    flags (1): solidness + 4·no-soft | corner (zz zz) | size (v v)
namespace {

enum Tag : std::uint8_t { kWorldTag = 0x01, kViewTag = 0x02, kTextTag = 0x03, kObjectTag = 0x10 };
enum MotionKind : std::uint8_t { kStill = 0, kLinear = 1, kAccelerated = 2 };

constexpr df::Fixed kMaxPosition = df::Fixed{2'100'000'000} << df::kFixedBits;
// Twice what an object may have: a model may have accelerated for one tick more than its object.
constexpr df::Fixed kMaxVelocity = df::Fixed{1} << (25 + df::kFixedBits);
constexpr df::Fixed kMaxBoxCorner = df::Fixed{1'000'001} << df::kFixedBits;
constexpr df::Fixed kMaxExtent = INT64_MAX;
constexpr std::uint64_t kMaxAltitude = 255;
constexpr std::size_t kMaxTextBytes = std::size_t{4} * kMaxViewWidth;
constexpr std::int64_t kGlyphStep = 1 << kGlyphUnitBits;

void writeVector(ByteWriter& out, df::FixedVector v) {
  out.zigzag(v.x);
  out.zigzag(v.y);
}

df::FixedVector readVector(ByteReader& in, df::Fixed most) {
  const df::Fixed x = in.within(most);
  return {x, in.within(most)};
}

df::FixedVector readSize(ByteReader& in, df::Fixed most) {
  const auto x = static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(most)));
  return {x, static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(most)))};
}

void writeMotion(ByteWriter& out, const Motion& m) {
  const df::FixedVector zero;
  const auto kind = m.acceleration != zero ? kAccelerated : m.velocity != zero ? kLinear : kStill;
  out.byte(kind);
  writeVector(out, m.position);
  if (kind != kStill) writeVector(out, m.velocity);
  if (kind == kAccelerated) writeVector(out, m.acceleration);
}

Motion readMotion(ByteReader& in, std::uint32_t tick) {
  Motion m;
  m.tick = tick;
  const std::uint8_t kind = in.byte();
  if (kind > kAccelerated) in.fail();
  m.position = readVector(in, kMaxPosition);
  if (kind != kStill) m.velocity = readVector(in, kMaxVelocity);
  if (kind == kAccelerated) m.acceleration = readVector(in, kMaxVelocity);
  return m;
}

// Neighbouring characters of a string differ by one cell in x and nothing else, so offsets are written as
// differences from "one cell to the right", and colour and row only where they change.
void writeAppearance(ByteWriter& out, const Appearance& glyphs) {
  assert(glyphs.size() <= kMaxGlyphs);
  out.varint(glyphs.size());
  Glyph last{-kGlyphStep, 0, U' ', df::COLOR_DEFAULT};
  for (const Glyph& glyph : glyphs) {
    const bool moved = glyph.dx != last.dx + kGlyphStep || glyph.dy != last.dy;
    const bool recolored = glyph.color != last.color;
    out.varint((static_cast<std::uint64_t>(glyph.ch) << 2) | (moved ? 2 : 0) | (recolored ? 1 : 0));
    if (moved) {
      out.zigzag(std::int64_t{glyph.dx} - last.dx - kGlyphStep);
      out.zigzag(std::int64_t{glyph.dy} - last.dy);
    }
    if (recolored) out.byte(static_cast<std::uint8_t>(glyph.color));
    last = glyph;
  }
}

df::Color readColor(ByteReader& in) {
  const std::uint8_t color = in.byte();
  if (color >= df::kColorCount) in.fail();
  return in.ok() ? static_cast<df::Color>(color) : df::COLOR_DEFAULT;
}

Appearance readAppearance(ByteReader& in) {
  Appearance glyphs;
  const std::uint64_t count = in.upTo(kMaxGlyphs);
  Glyph last{-kGlyphStep, 0, U' ', df::COLOR_DEFAULT};
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    const std::uint64_t head = in.upTo((0x10FFFFull << 2) | 3);
    std::int64_t dx = last.dx + kGlyphStep;
    std::int64_t dy = last.dy;
    if ((head & 2) != 0) {
      dx += in.within(4 * kMaxGlyphOffset);
      dy += in.within(4 * kMaxGlyphOffset);
    }
    if (std::max(std::abs(dx), std::abs(dy)) > kMaxGlyphOffset) in.fail();
    const auto ch = static_cast<char32_t>(head >> 2);
    if (!df::isDrawable(ch)) in.fail();
    const df::Color color = (head & 1) != 0 ? readColor(in) : last.color;
    if (!in.ok()) break;
    last = {static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy), ch, color};
    glyphs.push_back(last);
  }
  return glyphs;
}

void writeLook(ByteWriter& out, const Look& look) {
  assert(look.sequence.size() <= 1 && look.altitude >= 0);
  out.varint(static_cast<std::uint64_t>(look.altitude));
  out.varint(look.sequence.size());
  for (const Appearance& appearance : look.sequence) writeAppearance(out, appearance);
}

Look readLook(ByteReader& in) {
  Look look;
  look.altitude = static_cast<std::int32_t>(in.upTo(kMaxAltitude));
  const std::uint64_t count = in.upTo(1);
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) look.sequence.push_back(readAppearance(in));
  return look;
}

void writeBody(ByteWriter& out, const Body& body) {
  out.byte(static_cast<std::uint8_t>(body.solidness | (body.no_soft ? 4 : 0)));
  writeVector(out, body.box.corner);
  out.varint(static_cast<std::uint64_t>(body.box.size.x));
  out.varint(static_cast<std::uint64_t>(body.box.size.y));
}

Body readBody(ByteReader& in) {
  Body body;
  const std::uint8_t flags = in.byte();
  if ((flags & 3) > df::SPECTRAL || flags > 7) in.fail();
  body.solidness = static_cast<df::Solidness>(in.ok() ? flags & 3 : 0);
  body.no_soft = (flags & 4) != 0;
  body.box.corner = readVector(in, kMaxBoxCorner);
  body.box.size = readSize(in, kMaxBoxCorner);
  return body;
}

std::uint32_t readNumber(ByteReader& in, std::uint64_t most = UINT32_MAX) {
  return static_cast<std::uint32_t>(in.upTo(most));
}

WorldRecord readWorld(ByteReader& in) {
  WorldRecord record;
  record.boundary.corner = readVector(in, kMaxPosition);
  record.boundary.size = readSize(in, kMaxExtent);
  record.view_width = static_cast<std::int32_t>(in.upTo(kMaxViewWidth));
  record.view_height = static_cast<std::int32_t>(in.upTo(kMaxViewHeight));
  if (record.view_width < kMinViewWidth || record.view_height < kMinViewHeight) in.fail();
  return record;
}

ViewRecord readView(ByteReader& in) {
  ViewRecord record;
  record.corner = readVector(in, kMaxPosition);
  const std::uint64_t slot = in.upTo(kMaxSlots);
  if (slot != 0) {
    record.slot = static_cast<std::uint32_t>(slot - 1);
    record.generation = readNumber(in);
    if (record.generation == 0) in.fail();
  }
  return record;
}

TextRecord readText(ByteReader& in) {
  TextRecord record;
  record.id = readNumber(in, kMaxTexts - 1);
  record.x = static_cast<std::int32_t>(in.within(kMaxViewWidth));
  record.y = static_cast<std::int32_t>(in.within(kMaxViewHeight));
  record.color = readColor(in);
  record.text = std::string(in.bytes(in.upTo(kMaxTextBytes)));
  const std::u32string characters = df::decodeUtf8(record.text);
  if (!std::all_of(characters.begin(), characters.end(), df::isDrawable)) in.fail();
  return record;
}

ObjectRecord readObject(ByteReader& in, std::uint8_t groups, std::uint32_t tick) {
  ObjectRecord record;
  record.groups = groups;
  record.slot = readNumber(in, kMaxSlots - 1);
  record.generation = readNumber(in);
  if (record.generation == 0) in.fail();
  if ((groups & kLife) != 0) {
    if (groups != kAllGroups) in.fail();
    record.state.order = in.varint();
  }
  if ((groups & kMotion) != 0) record.state.motion = readMotion(in, tick);
  if ((groups & kLook) != 0) record.state.look = readLook(in);
  if ((groups & kBody) != 0) record.state.body = readBody(in);
  return record;
}

}  // namespace

void RecordWriter::write(const WorldRecord& record) {
  ByteWriter out(m_bytes);
  out.byte(kWorldTag);
  writeVector(out, record.boundary.corner);
  out.varint(static_cast<std::uint64_t>(record.boundary.size.x));
  out.varint(static_cast<std::uint64_t>(record.boundary.size.y));
  out.varint(static_cast<std::uint64_t>(record.view_width));
  out.varint(static_cast<std::uint64_t>(record.view_height));
}

void RecordWriter::write(const ViewRecord& record) {
  ByteWriter out(m_bytes);
  out.byte(kViewTag);
  writeVector(out, record.corner);
  out.varint(record.generation == 0 ? 0 : std::uint64_t{record.slot} + 1);
  if (record.generation != 0) out.varint(record.generation);
}

void RecordWriter::write(const TextRecord& record) {
  ByteWriter out(m_bytes);
  out.byte(kTextTag);
  out.varint(record.id);
  out.zigzag(record.x);
  out.zigzag(record.y);
  out.byte(static_cast<std::uint8_t>(record.color));
  out.varint(record.text.size());
  out.bytes(record.text);
}

void RecordWriter::write(const ObjectRecord& record) {
  assert((record.groups & kLife) == 0 || record.groups == kAllGroups);
  assert(record.generation != 0 && record.slot < kMaxSlots);
  ByteWriter out(m_bytes);
  out.byte(static_cast<std::uint8_t>(kObjectTag + record.groups));
  out.varint(record.slot);
  out.varint(record.generation);
  if ((record.groups & kLife) != 0) out.varint(record.state.order);
  if ((record.groups & kMotion) != 0) writeMotion(out, record.state.motion);
  if ((record.groups & kLook) != 0) writeLook(out, record.state.look);
  if ((record.groups & kBody) != 0) writeBody(out, record.state.body);
}

std::size_t encodedSize(const Look& look) {
  std::string bytes;
  ByteWriter out(bytes);
  writeLook(out, look);
  return bytes.size();
}

std::optional<Records> readRecords(std::string_view bytes, std::uint32_t tick) {
  ByteReader in(bytes);
  Records records;
  while (in.ok() && !in.atEnd()) {
    const std::uint8_t tag = in.byte();
    if (tag == kWorldTag) {
      records.worlds.push_back(readWorld(in));
    } else if (tag == kViewTag) {
      records.views.push_back(readView(in));
    } else if (tag == kTextTag) {
      records.texts.push_back(readText(in));
    } else if (tag >= kObjectTag && tag <= kObjectTag + kAllGroups) {
      records.objects.push_back(readObject(in, tag - kObjectTag, tick));
    } else {
      in.fail();
    }
  }
  if (!in.ok()) return std::nullopt;
  return records;
}

}  // namespace naiad
