#include "HostileWriter.h"

#include <algorithm>
#include <array>

#include "Prelude.h"
#include "shared/replica/Look.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad::fuzz {
namespace {

/// Number of fractional bits, by its code (4 bits) in a message.
constexpr std::array<int, 16> kFractions = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 16, 22, 32};
/// Upper limit of written numbers: exceeds every limit of the protocol without overflow.
constexpr std::uint64_t kHuge = std::uint64_t{1} << 62;
constexpr std::int64_t kMaxCells = 1'000'000'000;
constexpr std::int64_t kMaxBoxCells = 1'000'000;
constexpr std::int64_t kMaxOrder = (std::int64_t{1} << 48) - 1;

std::uint64_t low(std::uint64_t value, int bits) {
  return bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}

}  // namespace

void HostileWriter::begin(Kind first, int count) {
  constexpr int kKindBits = 5;
  const std::uint8_t bad = m_script.byte();
  m_out.clear();
  m_bad = static_cast<Kind>(static_cast<int>(first) + (bad & ((1 << kKindBits) - 1)) % count);
  m_good_before = bad >> kKindBits;
}

/// Makes a small number, or 2^n or 2^n − 1, because limits are near these. Uses exactly one byte of the
/// script, so that a change of this byte does not move the fields after it.
std::uint64_t HostileWriter::any() {
  const std::uint8_t head = m_script.byte();
  if (head < 0x80) return head;
  return (std::uint64_t{1} << (head >> 1 & 63)) - (head & 1);
}

std::uint64_t HostileWriter::choose(Kind kind, std::uint64_t most, std::uint64_t limit) {
  constexpr std::uint64_t kJustBeyond = 0x80;
  const std::uint64_t value = any();
  if (kind != m_bad || m_good_before-- != 0) return value % (most + 1);
  return value < kJustBeyond ? limit + 1 + value : value;
}

std::uint64_t HostileWriter::field(int bits) {
  const std::uint64_t value = low(any(), bits);
  m_out.bits(value, bits);
  return value;
}

std::uint64_t HostileWriter::field(Kind kind, int bits, std::uint64_t most) {
  const std::uint64_t value = low(choose(kind, most), bits);
  m_out.bits(value, bits);
  return value;
}

bool HostileWriter::flag() {
  return field(1) != 0;
}

std::uint64_t HostileWriter::golomb(Kind kind, int order, std::uint64_t most, std::uint64_t limit) {
  const std::uint64_t value = std::min(choose(kind, most, limit), kHuge);
  m_out.golomb(value, order);
  return value;
}

/// Returns a number from -most to most.
std::int64_t HostileWriter::centered(Kind kind, std::int64_t most) {
  const auto zigzag = std::min(choose(kind, 2 * static_cast<std::uint64_t>(most)), kHuge >> kGlyphUnitBits);
  return static_cast<std::int64_t>(zigzag >> 1) ^ -static_cast<std::int64_t>(zigzag & 1);
}

void HostileWriter::zeros(std::uint64_t count) {
  for (; count > 0; count -= std::min<std::uint64_t>(count, 64))
    m_out.bits(0, static_cast<int>(std::min<std::uint64_t>(count, 64)));
}

void HostileWriter::cell(std::int64_t origin) {
  m_out.signedGolomb(centered(Kind::kCell, kMaxCells) - origin, 10);
}

void HostileWriter::position() {
  const Origin& origin = preludeOrigin(m_slot);
  if (flag()) {
    field(origin.x_bits);
    field(origin.y_bits);
  } else {
    cell(origin.corner.x);
    cell(origin.corner.y);
  }
}

void HostileWriter::fraction() {
  const int bits = kFractions[field(4)];
  field(bits);
  field(bits);
}

/// Writes a vector. Each component is a whole number of cells in this range, and a fraction.
void HostileWriter::vector(std::int64_t least, std::int64_t most) {
  m_out.flag(false);
  for (int i = 0; i < 2; ++i) {
    m_out.signedGolomb(least + static_cast<std::int64_t>(std::min(
                                   choose(Kind::kVector, static_cast<std::uint64_t>(most - least)), kHuge)),
                       10);
  }
  fraction();
}

/// Writes steps of up to 26 whole bits, the width that the speed limit allows. In the bad field the width may
/// exceed 64 bits, which no type can hold.
void HostileWriter::steps() {
  const int bits = kFractions[field(4)];
  const std::uint64_t width =
      std::min<std::uint64_t>(choose(Kind::kWidth, static_cast<std::uint64_t>(26 + bits), 64), 1000);
  m_out.signedGolomb(static_cast<std::int64_t>(width) - bits, 1);
  if (width > 64) return zeros(2 * width);
  field(static_cast<int>(width));
  field(static_cast<int>(width));
}

void HostileWriter::motion() {
  position();
  const std::uint64_t kind = field(Kind::kMotion, 2, 2);
  fraction();
  if (kind != 0) steps();
  if (kind == 2) steps();
}

/// Writes an ASCII character, or a Latin letter beyond ASCII.
void HostileWriter::character() {
  const bool wide = flag();
  const std::uint64_t first = wide ? 0xAE : 0x20;
  const std::uint64_t most = wide ? 0x2FF - first : 0x7E - first;
  m_out.bits(low(first + choose(Kind::kCharacter, most), wide ? 14 : 7), wide ? 14 : 7);
}

void HostileWriter::appearance(bool whole) {
  constexpr std::uint64_t kEnough = 2 * kMaxGlyphs;  // enough for one glyph more than the limit
  const std::uint64_t glyphs = golomb(Kind::kGlyphs, 3, 15, kMaxGlyphs);
  constexpr std::int64_t kStep = 1 << kGlyphUnitBits;
  const std::int64_t unit = whole ? kStep : 1;
  const int order = whole ? 1 : 8;
  std::int64_t dx = -kStep;  // a glyph offset, without the half cell that a look may add
  std::int64_t dy = 0;
  for (std::uint64_t i = 0; i < std::min(glyphs, kEnough); ++i) {
    const bool at_edge = dx + 2 * kStep > kMaxGlyphOffset;
    const bool plain = whole && !at_edge && flag();
    if (whole && at_edge) m_out.flag(false);
    if (at_edge) m_out.flag(true);
    const bool moved = at_edge || (!plain && flag());
    const bool recoloured = !plain && flag();
    if (!whole || !flag()) character();
    if (moved) {
      const std::int64_t x = centered(Kind::kOffset, (kMaxGlyphOffset - kStep) / unit) * unit;
      const std::int64_t y = centered(Kind::kOffset, (kMaxGlyphOffset - kStep) / unit) * unit;
      m_out.signedGolomb((x - dx - kStep) / unit, order);
      m_out.signedGolomb((y - dy) / unit, order);
      dx = x;
      dy = y;
    } else {
      dx += kStep;
    }
    if (recoloured) field(3);
  }
}

/// Writes a sequence and returns the number of appearances that it claims.
std::uint64_t HostileWriter::sequence() {
  const bool one = flag();
  const std::uint64_t frames = one ? 1 : 2 + golomb(Kind::kFrames, 3, 3, kMaxFrames - 2);
  const bool whole = flag();
  if (whole) field(2);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(frames, 2 * kMaxFrames); ++i) appearance(whole);
  return frames;
}

void HostileWriter::selector(std::uint64_t frames) {
  if (flag()) return;
  const std::uint64_t kind = field(Kind::kSelector, 2, frames < 2 ? 0 : 3);
  switch (kind) {
    case 0:
      field(Kind::kSelector, 8, std::min<std::uint64_t>(frames, kMaxFrames) - 1);
      return;
    case 3: {
      const std::uint64_t code = field(3);
      field(static_cast<int>(4 * (code + 1)));
      const std::uint64_t width = field(Kind::kSelector, 6, 32);
      if (width <= 32) field(static_cast<int>(width));
      return;
    }
    default: {
      const std::uint64_t ticks = 1 + golomb(Kind::kSelector, 3, 20, kMaxTicksPerFrame - 1);
      const std::uint64_t count = std::min<std::uint64_t>(frames, kMaxFrames);
      const std::uint64_t oldest = kind == Selector::kClock ? count * ticks - 1 : (count - 1) * ticks;
      golomb(Kind::kSelector, 6, oldest, oldest);
    }
  }
}

void HostileWriter::look() {
  if (!flag()) field(8);
  switch (field(2)) {
    case 0:
      return;
    case 1:
      character();
      field(3);
      return;
    case 3:
      return selector(preludeFrames(field(Kind::kName, 12, kPreludeNames - 1)));
    default:
      break;
  }
  if (flag()) field(12);
  selector(sequence());
}

void HostileWriter::body() {
  if (!flag()) {
    vector(-kMaxBoxCells, kMaxBoxCells);
    vector(1, kMaxBoxCells);
  }
  field(2);
  field(1);
}

void HostileWriter::world() {
  vector(-kMaxCells, kMaxCells);
  field(Kind::kSize, 64, kHuge);
  field(Kind::kSize, 64, kHuge);
  m_out.bits(low(kMinViewWidth + choose(Kind::kViewWidth, kMaxViewWidth - kMinViewWidth), 9), 9);
  m_out.bits(low(kMinViewHeight + choose(Kind::kViewHeight, kMaxViewHeight - kMinViewHeight), 9), 9);
  field(3);
}

void HostileWriter::view() {
  vector(-kMaxCells, kMaxCells);
  if (!flag()) return;
  golomb(Kind::kFollowed, 6, kMaxSlots - 1);
  field(2);
}

/// Writes an origin of the prelude (Prelude.h) again, so that later positions relative to it stay correct.
void HostileWriter::origin() {
  const std::uint64_t slot = 1 + choose(Kind::kSlot, kOriginSlots - 1);
  const Origin& origin = preludeOrigin(slot);
  m_out.bits(low(slot, 2), 2);
  m_out.signedBits(origin.corner.x, 32);
  m_out.signedBits(origin.corner.y, 32);
  m_out.bits(static_cast<std::uint64_t>(origin.x_bits), 4);
  m_out.bits(static_cast<std::uint64_t>(origin.y_bits), 4);
  m_out.bits(origin.order, 48);
}

void HostileWriter::text() {
  field(4);
  m_out.signedGolomb(centered(Kind::kPlace, kMaxViewWidth), 6);
  m_out.signedGolomb(centered(Kind::kPlace, kMaxViewHeight), 4);
  field(3);
  const std::uint64_t length = golomb(Kind::kLength, 5, 15, kMaxViewWidth);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(length, 2 * kMaxViewWidth); ++i) character();
}

/// Writes no controls, which have their own target.
void HostileWriter::extras() {
  if (flag()) {
    const bool has_world = flag();
    const bool has_view = flag();
    field(Kind::kControls, 1, 0);
    const std::uint64_t origins = field(2);
    const std::uint64_t texts = field(Kind::kTexts, 5, kMaxTexts);
    if (has_world) world();
    if (has_view) view();
    for (std::uint64_t i = 0; i < origins; ++i) origin();
    for (std::uint64_t i = 0; i < texts; ++i) text();
  }
  field(Kind::kControls, 1, 0);
}

unsigned HostileWriter::groups() {
  switch (field(2)) {
    case 0:
      return kMotion;
    case 1:
      return kAllGroups;
    case 2:
      return kLook;
    default:
      break;
  }
  if (!flag()) return kDeath;
  const std::uint64_t which = low(1 + choose(Kind::kGroups, 6), 3);
  m_out.bits(which, 3);
  return static_cast<unsigned>(which) << 1;
}

void HostileWriter::object() {
  const unsigned parts = groups();
  if ((parts & kLife) != 0) {
    field(2);
    auto order = static_cast<std::int64_t>(std::min(choose(Kind::kOrder, kMaxOrder), kHuge));
    if (order > kMaxOrder && order % 2 != 0) order = kMaxOrder - order;  // negative
    m_out.signedGolomb(order - static_cast<std::int64_t>(preludeOrigin(m_slot).order), 10);
  }
  if ((parts & kMotion) != 0) motion();
  if ((parts & kLook) != 0) look();
  if ((parts & kBody) != 0) body();
}

std::string HostileWriter::snapshot(std::uint32_t number, std::uint32_t tick) {
  begin(Kind::kCell, 32);
  m_out.bits(number & 0xFFFF, 16);
  m_out.bits(tick & 0xFFFF, 16);
  m_out.bits(0, 2);
  field(1);
  if (flag()) {
    field(16);
    field(6);
  }
  m_slot = field(2);
  if (flag()) extras();
  const std::uint64_t objects = golomb(Kind::kObjects, 3, 12);
  const int order = objects > 0 ? static_cast<int>(field(4)) : 0;
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(objects, 12); ++i) {
    const std::uint64_t room = kMaxSlots - std::min<std::uint64_t>(next + objects - i, kMaxSlots);
    next += golomb(Kind::kId, order, room) + 1;
    object();
  }
  return m_out.bytes();
}

void HostileWriter::mask() {
  if (flag()) {
    field(64);
    return;
  }
  for (std::uint64_t missing = std::min<std::uint64_t>(golomb(Kind::kMissing, 0, 8), 64); missing > 0;
       --missing)
    field(6);
}

void HostileWriter::input(bool first) {
  if (first) {
    field(16);
  } else {
    m_out.signedGolomb(centered(Kind::kTicks, 1 << 15), 2);
  }
  golomb(Kind::kBehind, 3, 1 << 15);
  const bool mouse = flag();
  if (!mouse) field(Kind::kKey, 7, df::Keyboard::kKeyCount - 1);
  field(Kind::kAction, 2, df::KEY_DOWN);
  if (!mouse) return;
  field(2);
  field(Kind::kMouse, 9, kMaxViewWidth - 1);
  field(Kind::kMouse, 8, kMaxViewHeight - 1);
}

std::string HostileWriter::update() {
  begin(Kind::kMissing, 7);
  if (flag()) {
    field(16);
    mask();
  }
  if (flag()) field(64);
  field(1);
  const std::uint64_t inputs = golomb(Kind::kInputs, 0, kMaxUpdateInputs);
  if (inputs > 0) field(16);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(inputs, 256); ++i) input(i == 0);
  return m_out.bytes();
}

}  // namespace naiad::fuzz
