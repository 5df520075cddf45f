// Looks and bodies <-> bits.
#pragma once

#include <cstdint>
#include <optional>

#include "Bits.h"
#include "Records.h"
#include "Vocabulary.h"

namespace naiad {

/// How a look's appearance is written: spelled out, named by an id that the client knows, or spelled out
/// and given an id.
struct LookForm {
  enum Kind : std::uint8_t { kSpelled, kNamed, kDefined } kind = kSpelled;
  std::uint32_t id = 0;
};

void writeLook(BitWriter& out, const Look& look, LookForm form);
/// `define` is called for an appearance that gets an id, `find` for one that is named: it returns the
/// appearance, or null where there is none (then the reader fails).
template <class Define, class FindNamed>
Look readLook(BitReader& in, Define define, FindNamed find);

void writeAppearance(BitWriter& out, const Appearance& glyphs);
Appearance readAppearance(BitReader& in);

/// One character where the object is: what most looks are, and shorter than any name.
bool isSingleCharacter(const Appearance& appearance);

void writeCharacter(BitWriter& out, char32_t ch);
char32_t readCharacter(BitReader& in);
void writeColor(BitWriter& out, df::Color color);
df::Color readColor(BitReader& in);

void writeBody(BitWriter& out, const Body& body);
Body readBody(BitReader& in);

/// Bits that `appearance` takes, spelled out.
std::size_t encodedBits(const Appearance& appearance);

// ---- implementation ------------------------------------------------------------------------------------

namespace look_codec {
enum class Kind : std::uint8_t { kNothing, kCharacter, kSpelled, kNamed };
std::int32_t readAltitude(BitReader& in);
Kind readKind(BitReader& in);
Appearance readSingle(BitReader& in);
}  // namespace look_codec

template <class Define, class FindNamed>
Look readLook(BitReader& in, Define define, FindNamed find) {
  Look look;
  look.altitude = look_codec::readAltitude(in);
  switch (look_codec::readKind(in)) {
    case look_codec::Kind::kNothing:
      break;
    case look_codec::Kind::kCharacter:
      look.sequence.push_back(look_codec::readSingle(in));
      break;
    case look_codec::Kind::kSpelled: {
      const bool defines = in.flag();
      const auto id = defines ? static_cast<std::uint32_t>(in.bits(kAppearanceIdBits)) : 0;
      look.sequence.push_back(readAppearance(in));
      if (defines && in.ok()) define(id, look.sequence.back());
      break;
    }
    case look_codec::Kind::kNamed: {
      const auto id = static_cast<std::uint32_t>(in.bits(kAppearanceIdBits));
      const Appearance* appearance = in.ok() ? find(id) : nullptr;
      if (appearance != nullptr) look.sequence.push_back(*appearance);
      break;
    }
  }
  return look;
}

}  // namespace naiad
