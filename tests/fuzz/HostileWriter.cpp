#include "HostileWriter.h"

#include <algorithm>
#include <array>
#include <utility>

namespace naiad::fuzz {
namespace {

/// The numbers of bits behind the point, by code.
constexpr std::array<int, 16> kFractions = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 16, 22, 32};

std::uint64_t low(std::uint64_t value, int bits) {
  return bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}

}  // namespace

/// One byte gives a small number, or a power of two or one less: that is where limits are. Always one byte,
/// so that nothing behind it moves when it becomes another one.
std::uint64_t HostileWriter::any() {
  const std::uint8_t head = m_script.byte();
  if (head < 0x80) return head;
  return (std::uint64_t{1} << (head >> 1 & 63)) - (head & 1);
}

std::uint64_t HostileWriter::field(int bits) {
  const std::uint64_t value = low(any(), bits);
  m_out.bits(value, bits);
  return value;
}

bool HostileWriter::flag() {
  return field(1) != 0;
}

std::uint64_t HostileWriter::golomb(int order) {
  const std::uint64_t value = std::min(any(), ~std::uint64_t{0} - (std::uint64_t{1} << order));
  m_out.golomb(value, order);
  return value;
}

int HostileWriter::fraction() {
  const int bits = kFractions[field(4)];
  field(bits);
  field(bits);
  return bits;
}

void HostileWriter::position() {
  if (flag()) {  // near the origin: of windows of 64 by 32, as all are that the prelude has
    field(6);
    field(5);
  } else {
    golomb(10);
    golomb(10);
  }
}

void HostileWriter::vector() {
  m_out.flag(false);
  golomb(10);
  golomb(10);
  fraction();
}

void HostileWriter::steps() {
  const int bits = kFractions[field(4)];
  const std::uint64_t more = low(any(), 7);
  m_out.golomb(more, 1);
  const int width =
      bits + static_cast<int>(static_cast<std::int64_t>(more >> 1) ^ -static_cast<std::int64_t>(more & 1));
  if (width < 0 || width > 64) return;
  field(width);
  field(width);
}

void HostileWriter::motion() {
  position();
  const std::uint64_t kind = field(2);
  fraction();
  if (kind != 0) steps();
  if (kind == 2) steps();
}

/// 0 … 94 are drawable.
void HostileWriter::character() {
  const bool wide = flag();
  m_out.bits(low(any() + (wide ? 0xA0 : 0x20), wide ? 14 : 7), wide ? 14 : 7);
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
      field(12);
      return;
    default:
      break;
  }
  if (flag()) field(12);
  const std::uint64_t glyphs = golomb(3);
  for (std::uint64_t i = 0; i < glyphs && !m_script.atEnd(); ++i) {
    const bool moved = flag();
    const bool recoloured = flag();
    character();
    if (moved) {
      golomb(8);
      golomb(8);
    }
    if (recoloured) field(3);
  }
}

void HostileWriter::body() {
  if (!flag()) {
    vector();
    vector();
  }
  field(2);
  field(1);
}

void HostileWriter::extras() {
  const bool world = flag();
  const bool view = flag();
  const std::uint64_t origins = field(2);
  const std::uint64_t texts = field(5);
  if (world) {
    vector();
    for (const int bits : {64, 64, 9, 9}) field(bits);
  }
  if (view) {
    vector();
    if (flag()) {
      golomb(6);
      field(2);
    }
  }
  for (std::uint64_t i = 0; i < origins; ++i) {
    for (const int bits : {2, 32, 32, 4, 4, 48}) field(bits);
  }
  for (std::uint64_t i = 0; i < texts && !m_script.atEnd(); ++i) {
    field(4);
    golomb(6);
    golomb(4);
    field(3);
    const std::uint64_t length = golomb(5);
    for (std::uint64_t k = 0; k < length && !m_script.atEnd(); ++k) character();
  }
}

void HostileWriter::object() {
  constexpr unsigned kLife = 1;
  constexpr unsigned kMotion = 2;
  constexpr unsigned kLook = 4;
  constexpr unsigned kBody = 8;
  unsigned groups = 0;
  switch (field(2)) {
    case 0:
      groups = kMotion;
      break;
    case 1:
      groups = kLife | kMotion | kLook | kBody;
      break;
    case 2:
      groups = kLook;
      break;
    default:
      if (!flag()) return;  // dead
      groups = static_cast<unsigned>(field(3)) << 1;
  }
  if ((groups & kLife) != 0) {
    field(2);
    golomb(10);
  }
  if ((groups & kMotion) != 0) motion();
  if ((groups & kLook) != 0) look();
  if ((groups & kBody) != 0) body();
}

std::string HostileWriter::snapshot(std::uint32_t number, std::uint32_t tick) {
  m_out.clear();
  m_out.bits(number & 0xFFFF, 16);
  m_out.bits(tick & 0xFFFF, 16);
  m_out.bits(0, 2);
  field(1);
  if (flag()) {
    field(16);
    field(6);
  }
  field(2);
  if (flag()) extras();
  const std::uint64_t objects = golomb(3);
  const int order = objects > 0 ? static_cast<int>(field(4)) : 0;
  for (std::uint64_t i = 0; i < objects && !m_script.atEnd(); ++i) {
    golomb(order);
    object();
  }
  return m_out.bytes();
}

std::string HostileWriter::update() {
  m_out.clear();
  if (flag()) {
    field(16);
    if (!flag()) field(64);
  }
  if (flag()) field(8);
  if (flag()) field(64);
  field(1);
  const std::uint64_t inputs = golomb(0);
  if (inputs > 0) field(16);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(inputs, 256); ++i) {
    if (i == 0) {
      field(16);
    } else {
      golomb(2);
    }
    golomb(3);
    const bool mouse = flag();
    if (!mouse) field(7);
    field(2);
    if (!mouse) continue;
    field(2);
    field(9);
    field(8);
  }
  return m_out.bytes();
}

}  // namespace naiad::fuzz
