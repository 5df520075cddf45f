#include <gtest/gtest.h>

#include "RandomRecords.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"

namespace naiad {
namespace {

using test::RandomRecords;

/// Values that a reader received.
struct Met {
  Look look;
  std::optional<std::uint32_t> defined;
  std::optional<std::uint32_t> named;
  Sequence definition;
  bool whole = false;  ///< the bytes end exactly after the look
};

Met read(std::string_view bytes, const Sequence* known = nullptr) {
  Met met;
  BitReader in(bytes);
  met.look = readLook(
      in, 0,
      [&](std::uint32_t id, const Sequence& sequence) {
        met.defined = id;
        met.definition = sequence;
      },
      [&](std::uint32_t id) {
        met.named = id;
        return known;
      });
  met.whole = in.atEnd();
  return met;
}

std::string write(const Look& look, LookForm form = {}) {
  BitWriter out;
  writeLook(out, look, form, 0);
  return out.bytes();
}

/// Begins a look without a name, up to the number of its glyphs or of its frames.
BitWriter beginSpelled(bool has_one_frame) {
  BitWriter out;
  out.flag(true);
  out.bits(2, 2);
  out.flag(false);
  out.flag(has_one_frame);
  if (has_one_frame) out.flag(false);
  return out;
}

Look word(const char* text, df::Color color = df::GREEN) {
  Appearance glyphs;
  for (int x = 0; *text != '\0'; ++text, x += 256)
    glyphs.push_back({x, 0, static_cast<char32_t>(*text), color});
  return {{glyphs}, 2};
}

TEST(LookCodec, ADefinitionGivesIdAndSequence) {
  const Look look = word("saucer");
  const Met met = read(write(look, {LookForm::kDefined, 4095}));
  EXPECT_TRUE(met.whole);
  EXPECT_EQ(met.look, look);
  EXPECT_EQ(met.defined, 4095u);
  EXPECT_EQ(met.definition, look.sequence);
  EXPECT_FALSE(met.named);
}

TEST(LookCodec, ANameStandsForItsSequence) {
  Look look = word("saucer");
  look.altitude = 4;
  const std::string bytes = write(look, {LookForm::kNamed, 77});
  EXPECT_LE(bytes.size(), 3u);
  const Met met = read(bytes, &look.sequence);
  EXPECT_TRUE(met.whole);
  EXPECT_EQ(met.named, 77u);
  EXPECT_EQ(met.look, look);
}

TEST(LookCodec, SingleAndEmptyLooksNeedNoName) {
  for (const LookForm form : {LookForm{}, LookForm{LookForm::kNamed, 3}, LookForm{LookForm::kDefined, 3}}) {
    for (const Look& look : {Look{}, Look{{{{0, 0, U'@', df::CYAN}}}, 2}}) {
      const Met met = read(write(look, form));
      EXPECT_TRUE(met.whole);
      EXPECT_EQ(met.look, look);
      EXPECT_FALSE(met.defined || met.named);
    }
  }
  EXPECT_TRUE(isSingleCharacter({{{0, 0, U'@', df::CYAN}}}));
  EXPECT_FALSE(isSingleCharacter({{{1, 0, U'@', df::CYAN}}}));
  EXPECT_FALSE(isSingleCharacter({{{0, -1, U'@', df::CYAN}}}));
  EXPECT_FALSE(isSingleCharacter({}));
}

TEST(LookCodec, WordsEncodeCompactly) {
  // Each letter after the first takes: plain, a different one, narrow, 7 bits.
  EXPECT_EQ(encodedBits(word("saucers").sequence) - encodedBits(word("saucer").sequence), 10u);
  EXPECT_EQ(encodedBits(word("xxxx").sequence) - encodedBits(word("xxx").sequence), 2u);
  BitWriter one;
  writeLook(one, {{{{0, 0, U'@', df::CYAN}}}, 2}, {}, 0);
  EXPECT_EQ(one.bitCount(), 14u);
}

TEST(LookCodec, EncodedBitsMatchTheWrittenLook) {
  RandomRecords random(2);
  for (int i = 0; i < 500; ++i) {
    const Look look = random.look();
    if (look.sequence.empty() || isSingleCharacter(look.sequence)) continue;
    BitWriter selector;
    writeSelector(selector, look.selector, 0, look.sequence.size());
    BitWriter out;
    writeLook(out, look, {}, 0);
    ASSERT_EQ(out.bitCount(),
              encodedBits(look.sequence) + selector.bitCount() + (look.altitude == 2 ? 1u : 9u) + 2 + 1);
  }
}

TEST(LookCodec, OnlyDrawableCharactersAreRead) {
  for (char32_t ch = 0; ch < 1u << 14; ++ch) {
    BitWriter out;
    writeCharacter(out, ch);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    const char32_t back = readCharacter(in);
    ASSERT_EQ(in.ok(), df::isDrawable(ch)) << static_cast<std::uint32_t>(ch);
    if (in.ok()) {
      ASSERT_TRUE(back == ch) << static_cast<std::uint32_t>(ch);
    }
  }
  // Characters of more than 14 bits cannot be encoded, so none of them may be drawable.
  for (char32_t ch = 1u << 14; ch < 0x110000; ++ch) ASSERT_FALSE(df::isDrawable(ch));
}

TEST(LookCodec, GlyphsBeyondTheOffsetLimitAreRefused) {
  const auto isRead = [](std::int32_t dx, std::int32_t dy) {
    return read(write({{{{0, 0, U'a', df::RED}, {dx, dy, U'b', df::RED}}}, 2})).whole;
  };
  const auto most = static_cast<std::int32_t>(kMaxGlyphOffset);
  EXPECT_TRUE(isRead(most, -most));
  EXPECT_TRUE(isRead(-most, most));
  EXPECT_FALSE(isRead(most + 1, 0));
  EXPECT_FALSE(isRead(-most - 1, 0));
  EXPECT_FALSE(isRead(0, most + 1));
  EXPECT_FALSE(isRead(0, -most - 1));
}

// Each glyph is at the implied distance from the previous one, so only the sum of distances exceeds the
// limit.
TEST(LookCodec, GlyphsSummingBeyondTheOffsetLimitAreRefused) {
  const auto start = static_cast<std::int32_t>(kMaxGlyphOffset) - 256;
  Look look{{{{start, 0, U'a', df::RED}, {start + 256, 0, U'b', df::RED}}}, 2};
  EXPECT_TRUE(read(write(look)).whole);
  look.sequence = {{look.sequence[0][0], look.sequence[0][1], {start + 512, 0, U'c', df::RED}}};
  EXPECT_FALSE(read(write(look)).whole);
}

TEST(LookCodec, LargestAppearanceFitsALargerOneIsRefused) {
  Look look{{Appearance(kMaxGlyphs, Glyph{0, 0, U'#', df::RED})}, 2};
  EXPECT_EQ(read(write(look)).look, look);
  BitWriter out = beginSpelled(true);
  out.golomb(kMaxGlyphs + 1, 3);
  for (int i = 0; i < 200'000; ++i) out.flag(false);
  EXPECT_FALSE(read(out.bytes()).whole);
}

TEST(LookCodec, ClaimedGlyphCountReservesLittleMemory) {
  BitWriter out = beginSpelled(true);
  out.golomb(kMaxGlyphs, 3);
  const Met met = read(out.bytes());
  EXPECT_FALSE(met.whole);
  EXPECT_LE(met.look.sequence[0].capacity(), 8u);
}

// The limits apply to the whole sequence, not to each appearance.
TEST(LookCodec, AllFramesShareTheGlyphLimit) {
  const Appearance half(kMaxGlyphs / 2, Glyph{0, 0, U'#', df::RED});
  const auto bytes = [](const Appearance& a, const Appearance& b) {
    BitWriter out = beginSpelled(false);
    out.golomb(0, 3);
    out.bits(0b001, 3);
    for (const Appearance& appearance : {a, b}) {
      out.golomb(appearance.size(), 3);
      for (std::size_t i = 0; i < appearance.size(); ++i) {
        const bool plain = i > 0;
        out.flag(plain);
        if (!plain) out.bits(0b10, 2);
        out.flag(true);
        if (!plain) writeColor(out, df::RED);
      }
    }
    out.flag(true);
    return out.bytes();
  };
  EXPECT_TRUE(read(bytes(half, half)).whole);
  Appearance more = half;
  more.push_back(more.back());
  EXPECT_FALSE(read(bytes(half, more)).whole);
}

TEST(LookCodec, LongestSequenceFitsALongerOneIsRefused) {
  const auto isRead = [](std::size_t count) {
    BitWriter out = beginSpelled(false);
    out.golomb(count - 2, 3);
    out.bits(0b001, 3);
    for (std::size_t i = 0; i < count; ++i) out.golomb(0, 3);
    out.flag(true);
    return read(out.bytes()).whole;
  };
  EXPECT_TRUE(isRead(2));
  EXPECT_TRUE(isRead(kMaxFrames));
  EXPECT_FALSE(isRead(kMaxFrames + 1));
}

TEST(LookCodec, SelectorsSurviveTheRoundTripAtAnyTick) {
  RandomRecords random(7);
  for (int i = 0; i < 20'000; ++i) {
    const std::size_t frames = 2 + random.rng().below(kMaxFrames - 1);
    const auto tick = static_cast<std::uint32_t>(random.rng().next());
    const Selector selector = random.selector(frames).rebased(tick, frames);
    BitWriter out;
    writeSelector(out, selector, tick, frames);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    ASSERT_EQ(readSelector(in, tick), selector);
    ASSERT_TRUE(in.atEnd());
  }
}

TEST(LookCodec, OutOfRangeSelectorsAreRefused) {
  const auto isRead = [](auto write) {
    BitWriter out;
    out.flag(false);
    write(out);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    readSelector(in, 5);
    return in.ok() && in.atEnd();
  };
  const auto clock = [&](std::uint64_t ticks, std::uint64_t age) {
    return isRead([=](BitWriter& out) {
      out.bits(1, 2);
      out.golomb(ticks, 3);
      out.golomb(age, 6);
    });
  };
  EXPECT_TRUE(clock(kMaxTicksPerFrame - 1, kMaxFrames * kMaxTicksPerFrame - 1));
  EXPECT_FALSE(clock(kMaxTicksPerFrame, 0));
  EXPECT_FALSE(clock(0, kMaxFrames * kMaxTicksPerFrame));
  const auto spin = [&](std::uint64_t width) {
    return isRead([=](BitWriter& out) {
      out.bits(3, 2);
      out.bits(0, 3);
      out.bits(5, 4);
      out.bits(width, 6);
      out.bits(0, static_cast<int>(width));
    });
  };
  EXPECT_TRUE(spin(0));
  EXPECT_TRUE(spin(32));
  EXPECT_FALSE(spin(33));
  EXPECT_FALSE(spin(63));
}

// A clock has only one valid age per tick, so that looks with equal pictures have equal encodings.
TEST(LookCodec, ClocksOlderThanOneCycleAreRefused) {
  const Appearance a{{256, 0, U'a', df::RED}};
  const Sequence three{a, {}, a};
  const auto isRead = [&](Selector::Kind kind, std::uint64_t age, bool named) {
    BitWriter out;
    out.flag(true);
    out.bits(named ? 3 : 2, 2);
    if (named) out.bits(7, 12);
    if (!named) out.flag(false);
    if (!named) writeSequence(out, three);
    out.flag(false);
    out.bits(kind, 2);
    out.golomb(5 - 1, 3);
    out.golomb(age, 6);
    return read(out.bytes(), &three).whole;
  };
  for (const bool named : {false, true}) {
    EXPECT_TRUE(isRead(Selector::kClock, 14, named));
    EXPECT_FALSE(isRead(Selector::kClock, 15, named));
    EXPECT_TRUE(isRead(Selector::kClockOnce, 10, named));
    EXPECT_FALSE(isRead(Selector::kClockOnce, 11, named));
  }
}

// A change of a body's spin takes: the name, the angle to a fraction of a frame, and the spin.
TEST(LookCodec, SpinChangeOfANamedSequenceIsShort) {
  const Appearance a{{256, 0, U'a', df::RED}};
  BitWriter out;
  writeLook(out, {{a, {}, a, {}}, 2, Selector::turning(0, 0xABC00000, 20'000'000)}, {LookForm::kNamed, 7}, 0);
  EXPECT_EQ(out.bitCount(), 1u + 2 + 12 + 1 + 2 + 3 + 12 + 6 + 26);
}

TEST(LookCodec, BodiesSurviveTheRoundTrip) {
  RandomRecords random(3);
  for (int i = 0; i < 3000; ++i) {
    Body body = random.body();
    if (i % 3 == 0) body.box = Body{}.box;
    BitWriter out;
    writeBody(out, body);
    if (i % 3 == 0) {
      ASSERT_EQ(out.bitCount(), 4u);
    }
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    ASSERT_EQ(readBody(in), body);
    ASSERT_TRUE(in.atEnd());
  }
}

TEST(LookCodec, BodiesOutOfRangeAreRefused) {
  const auto isRead = [](const Body& body) {
    BitWriter out;
    writeBody(out, body);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    readBody(in);
    return in.ok();
  };
  const df::Fixed most = df::fromCells(1'000'001);
  EXPECT_TRUE(isRead({{{-most, most}, {most, 0}}, df::SPECTRAL, true}));
  EXPECT_FALSE(isRead({{{-most - 1, 0}, {1, 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {1, most + 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {-1, 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {1, -1}}, df::HARD, false}));
  EXPECT_TRUE(isRead({Body{}.box, df::SPECTRAL, false, true}));
}

}  // namespace
}  // namespace naiad
