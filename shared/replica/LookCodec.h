// Encodes looks and bodies as bits, and decodes them.
#pragma once

#include <cstdint>
#include <optional>

#include "shared/replica/Bits.h"
#include "shared/replica/Records.h"
#include "shared/replica/SnapshotDictionary.h"

namespace naiad {

/// The encoding of a look's sequence: in full (kInline), as an id that the client knows (kNamed), or in full
/// with a new id (kDefined).
struct LookForm {
  enum Kind : std::uint8_t { kInline, kNamed, kDefined } kind = kInline;
  std::uint32_t id = 0;
};

/// `tick`: the snapshot's tick, to which the starts of clocks are relative.
void writeLook(BitWriter& out, const Look& look, LookForm form, std::uint32_t tick);
/// Calls `define` for a sequence with a new id, and `find_named` for an id without a sequence. `find_named`
/// returns the id's sequence, or null if it is not known yet; then the caller must look it up later, and
/// check that the selector isCanonical().
template <class Define, class FindNamed>
Look readLook(BitReader& in, std::uint32_t tick, Define define, FindNamed find_named);

void writeSequence(BitWriter& out, const Sequence& sequence);
Sequence readSequence(BitReader& in);
/// Encodes a selector at `tick`. `frames`: number of appearances in its sequence.
void writeSelector(BitWriter& out, const Selector& selector, std::uint32_t tick, std::size_t frames);
Selector readSelector(BitReader& in, std::uint32_t tick);

/// True for one character at the object's position: the most frequent look, usually shorter than an id.
bool isSingleCharacter(const Sequence& sequence);

void writeCharacter(BitWriter& out, char32_t ch);
char32_t readCharacter(BitReader& in);
void writeColor(BitWriter& out, df::Color color);
df::Color readColor(BitReader& in);

/// The code for the solidness of objects on the view.
inline constexpr std::uint64_t kOnViewSolidness = 3;
std::uint64_t wireSolidness(const Body& body);
void writeBody(BitWriter& out, const Body& body);
Body readBody(BitReader& in);

/// Returns the size of `sequence`, encoded in full, in bits.
std::size_t encodedBits(const Sequence& sequence);

// ---- implementation ------------------------------------------------------------------------------------

namespace look_codec {
enum class Kind : std::uint8_t { kNothing, kCharacter, kInline, kNamed };
std::int32_t readAltitude(BitReader& in);
Kind readKind(BitReader& in);
Appearance readSingle(BitReader& in);
}  // namespace look_codec

template <class Define, class FindNamed>
Look readLook(BitReader& in, std::uint32_t tick, Define define, FindNamed find_named) {
  Look look;
  look.altitude = look_codec::readAltitude(in);
  switch (look_codec::readKind(in)) {
    case look_codec::Kind::kNothing:
      return look;
    case look_codec::Kind::kCharacter:
      look.sequence = {look_codec::readSingle(in)};
      return look;
    case look_codec::Kind::kInline: {
      const bool defines = in.flag();
      const auto id = defines ? static_cast<std::uint32_t>(in.bits(kAppearanceIdBits)) : 0;
      look.sequence = readSequence(in);
      look.selector = readSelector(in, tick);
      if (!look.selector.isCanonical(tick, look.sequence.size())) in.fail();
      if (defines && in.ok()) define(id, look.sequence);
      break;
    }
    case look_codec::Kind::kNamed: {
      const auto id = static_cast<std::uint32_t>(in.bits(kAppearanceIdBits));
      look.selector = readSelector(in, tick);
      const Sequence* sequence = in.ok() ? find_named(id) : nullptr;
      if (sequence == nullptr) return look;
      look.sequence = *sequence;
      if (!look.selector.isCanonical(tick, look.sequence.size())) in.fail();
      break;
    }
  }
  return look;
}

}  // namespace naiad
